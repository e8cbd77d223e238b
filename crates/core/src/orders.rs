//! Series through as few orders as a caller needs.
//!
//! A product of two series of slopes takes 75 multiplications through order 4, 30 through order 2
//! and 15 through order 1. The coefficients that are left have the same bits: see [`Taylor`].

use std::array::from_fn;

use crate::{Dual, Lanes, ORDER, Series, Taylor};

/// The orders through which a caller needs the series of a surface, 4 at the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SeriesOrders {
    /// The order of the heights. It is at least that of the slopes.
    pub heights: usize,
    /// The order of the slopes.
    pub slopes: usize,
}

impl SeriesOrders {
    /// All orders.
    pub const ALL: Self = Self {
        heights: ORDER,
        slopes: ORDER,
    };
}

/// How many curves go through a formula together for low orders.
const CURVES: usize = 4;

/// Curves side by side, with the derivatives of each coefficient in x and y.
pub(crate) type Tangents<const N: usize> = Taylor<Dual<Lanes<CURVES>>, N>;
/// Curves side by side.
pub(crate) type Curves<const N: usize> = Taylor<Lanes<CURVES>, N>;

/// The first `N` coefficients of the series of heights and of both slopes along the curves. The
/// others are left as they are. All slices have the same length.
pub(crate) fn first_coefficients<const N: usize>(
    sag: impl Fn(Tangents<N>, Tangents<N>) -> Tangents<N>,
    (x, y): (&[Series], &[Series]),
    out: [&mut [Series]; 3],
) {
    let [z, zx, zy] = out.map(|column| column.chunks_mut(CURVES));
    let curves = x.chunks(CURVES).zip(y.chunks(CURVES));
    for ((((x, y), z), zx), zy) in curves.zip(z).zip(zx).zip(zy) {
        let flat = Lanes([0.0; CURVES]);
        let dual = |value| Dual {
            value,
            dx: flat,
            dy: flat,
        };
        let [mut along_x, mut along_y] = [x, y].map(|c| Taylor(side_by_side::<N>(c).map(dual)));
        along_x.0[0].dx = Lanes([1.0; CURVES]);
        along_y.0[0].dy = Lanes([1.0; CURVES]);
        for (k, c) in sag(along_x, along_y).0.iter().enumerate() {
            for (lane, z) in z.iter_mut().enumerate() {
                z[k] = c.value.0[lane];
                zx[lane][k] = c.dx.0[lane];
                zy[lane][k] = c.dy.0[lane];
            }
        }
    }
}

/// The first `N` coefficients of the series of heights along the curves. The others are left as they
/// are. All slices have the same length.
pub(crate) fn first_heights<const N: usize>(
    sag: impl Fn(Curves<N>, Curves<N>) -> Curves<N>,
    (x, y): (&[Series], &[Series]),
    z: &mut [Series],
) {
    let curves = x.chunks(CURVES).zip(y.chunks(CURVES));
    for ((x, y), z) in curves.zip(z.chunks_mut(CURVES)) {
        let [along_x, along_y] = [x, y].map(|c| Taylor(side_by_side::<N>(c)));
        for (k, c) in sag(along_x, along_y).0.iter().enumerate() {
            for (z, c) in z.iter_mut().zip(c.0) {
                z[k] = c;
            }
        }
    }
}

/// The first coefficients of up to [`CURVES`] curves, those of one order in the lanes of one number.
/// Lanes that are left over have the last curve once more.
fn side_by_side<const N: usize>(curves: &[Series]) -> [Lanes<CURVES>; N] {
    let last = curves.len() - 1;
    from_fn(|k| Lanes(from_fn(|lane| curves[lane.min(last)][k])))
}
