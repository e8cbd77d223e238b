//! Points through a formula: heights and slopes. Formulas with loops or calls take several points side by side in
//! [lanes](crate::Lanes). Through others the points go one by one, and the compiler puts them side by side.

use super::columns::Gradients;
use super::formula::Surface;
use crate::registers::{LaneLoop, Loop};
use crate::{Dual, Lanes, Scalar};

/// How many points go through a formula together: as many as the widest registers hold.
const WIDTH: usize = 8;

/// The loop of [`SurfaceModel::heights`](super::SurfaceModel::heights).
pub struct Heights<'a, T>(pub &'a T, pub &'a [f64], pub &'a [f64], pub &'a mut [f64]);

impl<T: Surface> Loop for Heights<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(surface, x, y, z) = self;
        let (xs, x_rest) = x.as_chunks::<WIDTH>();
        let (ys, y_rest) = y.as_chunks::<WIDTH>();
        let (zs, z_rest) = z.as_chunks_mut::<WIDTH>();
        for ((z, x), y) in zs.iter_mut().zip(xs).zip(ys) {
            *z = surface.sag(Lanes(*x), Lanes(*y)).0;
        }
        Heights(surface, x_rest, y_rest, z_rest).one_by_one();
    }
}

impl<T: Surface> LaneLoop for Heights<'_, T> {
    #[inline(always)]
    fn one_by_one(self) {
        let Self(surface, x, y, z) = self;
        for ((z, x), y) in z.iter_mut().zip(x).zip(y) {
            *z = surface.sag(*x, *y);
        }
    }
}

/// The loop of [`SurfaceModel::gradient`](super::SurfaceModel::gradient).
pub struct Slopes<'a, T>(pub &'a T, pub &'a [f64], pub &'a [f64], pub Gradients<'a>);

impl<T: Surface> Loop for Slopes<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(surface, x, y, Gradients { z, zx, zy }) = self;
        let (xs, x_rest) = x.as_chunks::<WIDTH>();
        let (ys, y_rest) = y.as_chunks::<WIDTH>();
        let (zs, z_rest) = z.as_chunks_mut::<WIDTH>();
        let (zxs, zx_rest) = zx.as_chunks_mut::<WIDTH>();
        let (zys, zy_rest) = zy.as_chunks_mut::<WIDTH>();
        for ((((x, y), z), zx), zy) in xs.iter().zip(ys).zip(zs).zip(zxs).zip(zys) {
            let sag = sag_and_slopes(surface, Lanes(*x), Lanes(*y));
            (*z, *zx, *zy) = (sag.value.0, sag.dx.0, sag.dy.0);
        }
        let rest = Gradients {
            z: z_rest,
            zx: zx_rest,
            zy: zy_rest,
        };
        Slopes(surface, x_rest, y_rest, rest).one_by_one();
    }
}

impl<T: Surface> LaneLoop for Slopes<'_, T> {
    #[inline(always)]
    fn one_by_one(self) {
        let Self(surface, x, y, Gradients { z, zx, zy }) = self;
        for ((((x, y), z), zx), zy) in x.iter().zip(y).zip(z).zip(zx).zip(zy) {
            let sag = sag_and_slopes(surface, *x, *y);
            (*z, *zx, *zy) = (sag.value, sag.dx, sag.dy);
        }
    }
}

#[inline(always)]
fn sag_and_slopes<T: Surface + ?Sized, S: Scalar>(surface: &T, x: S, y: S) -> Dual<S> {
    surface.sag(Dual::variable_x(x), Dual::variable_y(y))
}
