//! The side of a surface on which the tool stands.

use crate::error::{LensProblem, ProblemKind};
use crate::medium::{Medium, before, comes_along_z};
use crate::surface_block::SurfaceBlock;

/// A side of a surface, by the z axis of the design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Where z is less: the surface is seen from behind, and x and z change their signs.
    MinusZ,
    /// Where z is more.
    PlusZ,
}

/// The side from which a surface is cut, and why: the side without material.
///
/// # Errors
/// When the file does not say on which side the material is.
pub fn cut_from(
    blocks: &[SurfaceBlock<'_>],
    block: &SurfaceBlock<'_>,
) -> Result<(Side, &'static str), LensProblem> {
    let undecided = |why| Err(ProblemKind::Side(why).at(block.line));
    let (first, why) = match (before(blocks, block.number), block.glass()) {
        (Medium::Air, Some(true)) => (true, "the light reaches the mirror there"),
        (Medium::Glass, Some(true)) => (false, "the mirror has glass before it"),
        (Medium::Air, Some(false)) => (true, "the glass lies behind the surface"),
        (Medium::Glass, None) => (false, "the glass lies before the surface"),
        (Medium::Glass, Some(false)) => {
            return undecided("the surface has glass on both sides");
        }
        (Medium::Air, None) => return undecided("the surface has air on both sides"),
    };
    match comes_along_z(blocks, block.number) {
        None => undecided(
            "the distance or a break of coordinates before the surface leaves open which way the light goes there",
        ),
        Some(along) if along == first => Ok((Side::MinusZ, why)),
        Some(_) => Ok((Side::PlusZ, why)),
    }
}
