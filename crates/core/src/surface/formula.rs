//! The formula of a surface, as its author writes it.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::Scalar;

/// A surface z = f(x, y), written once for every number type. Lengths are in mm, and z points to
/// the tool.
///
/// The formula must also hold beyond the aperture, since the tool runs over the rim. Where the
/// formula has no value it gives NaN.
pub trait Surface: Send + Sync {
    /// Whether the compiler makes the loops over the formula once more for each width of [vector
    /// registers](crate::registers). A formula through which few points go, as in a test, says `false`.
    /// Then it compiles several times as fast, and its bits are the same. The constants below count
    /// only where this one is true.
    const IN_WIDE_REGISTERS: bool = true;

    /// Whether the compiler puts many points, and series of many curves, side by side in vector registers. It
    /// does so, and nothing is faster, if the formula has neither loops nor calls and is marked `#[inline(always)]`:
    /// sums, products, quotients, roots and choices. A formula with loops or calls says `false`: otherwise its
    /// points and curves go one by one. All ways give the same bits.
    const SIDE_BY_SIDE: bool = true;

    /// Most coefficients with which series of heights go through the formula in [lanes](crate::Lanes), where
    /// [`SIDE_BY_SIDE`](Self::SIDE_BY_SIDE) is false. Each coefficient takes a register. Lanes are faster if
    /// the formula is marked `#[inline(always)]`, and the compiler makes it once more for each count. Series
    /// of more coefficients go one by one.
    const HEIGHT_COEFFICIENTS_IN_LANES: usize = 5;

    /// The same for series of heights and slopes, whose coefficients take three registers each.
    const SLOPE_COEFFICIENTS_IN_LANES: usize = 3;

    /// The height at (x, y).
    fn sag<S: Scalar>(&self, x: S, y: S) -> S;

    /// Why there is no height or no slope at (x, y), if a part of a parameter's text says so. Most
    /// surfaces have no such text: the default is `None`.
    fn gap(&self, x: f64, y: f64) -> Option<SurfaceGap> {
        let _ = (x, y);
        None
    }
}

/// Why a surface has no height or no slope at a place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SurfaceGap {
    /// The number of the surface in a sum, else 0.
    pub entry: usize,
    /// The parameter whose text says so, by its key in the recipe.
    pub param: String,
    /// The bytes of the text.
    pub place: Range<usize>,
    /// What happens there, as in "the root of a negative number".
    pub reason: String,
}
