//! Curves through a formula: series of heights and slopes, a strip of curves at a time.
//!
//! Where the formula has neither loops nor calls, the compiler puts the curves of a
//! [strip](crate::strip) side by side. Curves through other formulas go in [lanes](crate::Lanes), or one at
//! a time where a number has so many coefficients that the registers do not hold their lanes.

use super::columns::GradientSeries;
use super::formula::Surface;
use crate::registers::{LaneLoop, Loop};
use crate::strip::{Group, STRIP, blank, gather, groups, scatter};
use crate::{Dual, Lanes, Scalar, Series, Taylor};

/// Coefficients with their derivatives in x and y, which are none so far.
#[inline(always)]
fn as_duals<S: Scalar, const N: usize>(series: Taylor<S, N>) -> Taylor<Dual<S>, N> {
    let zero = S::constant(0.0);
    let dual = |value| Dual {
        value,
        dx: zero,
        dy: zero,
    };
    let mut duals = Taylor([dual(zero); N]);
    for (place, value) in duals.0.iter_mut().zip(series.0) {
        *place = dual(value);
    }
    duals
}

/// The loop that gives curves the first `N` coefficients of their heights. All slices have one
/// length.
pub struct HeightsAlong<'a, T, const N: usize> {
    surface: &'a T,
    x: &'a [Series],
    y: &'a [Series],
    z: &'a mut [Series],
}

impl<'a, T, const N: usize> HeightsAlong<'a, T, N> {
    /// The loop over the curves (x, y).
    pub fn new(surface: &'a T, (x, y): (&'a [Series], &'a [Series]), z: &'a mut [Series]) -> Self {
        Self { surface, x, y, z }
    }
}

impl<T: Surface, const N: usize> HeightsAlong<'_, T, N> {
    #[inline(always)]
    fn through<S: Group>(self) {
        let Self { surface, x, y, z } = self;
        let (mut along_x, mut along_y, mut heights) = (blank::<N>(), blank(), blank::<N>());
        let curves = x.chunks(STRIP).zip(y.chunks(STRIP));
        for ((x, y), z) in curves.zip(z.chunks_mut(STRIP)) {
            gather(x, &mut along_x);
            gather(y, &mut along_y);
            for first in groups::<S>(x.len()) {
                let (x, y) = (S::take(&along_x, first), S::take(&along_y, first));
                S::put(first, surface.sag(x, y), &mut heights);
            }
            scatter(&heights, z);
        }
    }
}

impl<T: Surface, const N: usize> Loop for HeightsAlong<'_, T, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.through::<f64>();
    }
}

/// The loop that gives curves the first `N` coefficients of their heights and of both slopes. All
/// slices have one length.
pub struct SlopesAlong<'a, T, const N: usize> {
    surface: &'a T,
    x: &'a [Series],
    y: &'a [Series],
    out: GradientSeries<'a>,
}

impl<'a, T, const N: usize> SlopesAlong<'a, T, N> {
    /// The loop over the curves (x, y).
    pub fn new(
        surface: &'a T,
        (x, y): (&'a [Series], &'a [Series]),
        out: GradientSeries<'a>,
    ) -> Self {
        Self { surface, x, y, out }
    }
}

impl<T: Surface, const N: usize> SlopesAlong<'_, T, N> {
    #[inline(always)]
    fn through<S: Group>(self) {
        let Self { surface, x, y, out } = self;
        let (mut along_x, mut along_y) = (blank::<N>(), blank::<N>());
        let (mut heights, mut slopes_x, mut slopes_y) = (blank::<N>(), blank::<N>(), blank::<N>());
        let curves = x.chunks(STRIP).zip(y.chunks(STRIP));
        let slopes = out.zx.chunks_mut(STRIP).zip(out.zy.chunks_mut(STRIP));
        for (((x, y), z), (zx, zy)) in curves.zip(out.z.chunks_mut(STRIP)).zip(slopes) {
            gather(x, &mut along_x);
            gather(y, &mut along_y);
            for first in groups::<S>(x.len()) {
                let curves = [S::take(&along_x, first), S::take(&along_y, first)];
                let [mut x, mut y] = curves.map(as_duals);
                (x.0[0].dx, y.0[0].dy) = (S::constant(1.0), S::constant(1.0));
                let sag = surface.sag(x, y).0;
                S::put(first, Taylor(sag.map(|c| c.value)), &mut heights);
                S::put(first, Taylor(sag.map(|c| c.dx)), &mut slopes_x);
                S::put(first, Taylor(sag.map(|c| c.dy)), &mut slopes_y);
            }
            scatter(&heights, z);
            scatter(&slopes_x, zx);
            scatter(&slopes_y, zy);
        }
    }
}

impl<T: Surface, const N: usize> Loop for SlopesAlong<'_, T, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.through::<f64>();
    }
}

/// Number of curves in [lanes](crate::Lanes).
const WIDTH: usize = 8;

/// The same loop with curves in lanes.
pub struct InLanes<L>(pub L);

impl<T: Surface, const N: usize> Loop for InLanes<HeightsAlong<'_, T, N>> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.through::<Lanes<WIDTH>>();
    }
}

impl<T: Surface, const N: usize> Loop for InLanes<SlopesAlong<'_, T, N>> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.through::<Lanes<WIDTH>>();
    }
}

impl<L: Loop> LaneLoop for InLanes<L>
where
    Self: Loop<Output = L::Output>,
{
    #[inline(always)]
    fn one_by_one(self) -> L::Output {
        self.0.call()
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::{ORDER, Scalar};

    /// A formula without loops and calls: sums, products, quotients, roots and choices.
    struct Lens;

    impl Surface for Lens {
        #[inline(always)]
        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = x.squared() + y.squared() * 1.3 - x * y * 0.2;
            let root = (square * 0.4 + 2.0).sqrt();
            let tilted = S::select(x.less(y), x * 0.1, -y);
            square / (root + 1.0) + tilted.max(y * 0.3) - root.recip()
        }
    }

    /// More curves than a strip has, and not a whole number of strips.
    fn curves() -> (Vec<Series>, Vec<Series>) {
        let curve = |i: usize| {
            let t = 0.1 * i as f64;
            let x = [0.3 * t - 1.0, 1.0, -0.2 * t, 0.05, 0.01];
            (x, [0.9 - 0.2 * t, 0.4 + t, 0.3, -0.1 * t, 0.02])
        };
        (0..2 * STRIP + 13).map(curve).unzip()
    }

    fn bits(series: &[Series], orders: usize) -> Vec<u64> {
        let coefficients = series.iter().flat_map(|c| &c[..orders]);
        coefficients.map(|c| c.to_bits()).collect()
    }

    fn has_the_bits_of_curves_alone<const N: usize>() {
        let (x, y) = curves();
        let blank = vec![[f64::NAN; ORDER + 1]; x.len()];
        let [mut z, mut zx, mut zy, mut heights] = [(); 4].map(|()| blank.clone());
        for i in 0..x.len() {
            let [mut along_x, mut along_y] = [x[i], y[i]].map(Taylor::<Dual<f64>>::from_series);
            (along_x.0[0].dx, along_y.0[0].dy) = (1.0, 1.0);
            let sag = Lens.sag(along_x, along_y).0;
            z[i] = sag.map(|c| c.value);
            (zx[i], zy[i]) = (sag.map(|c| c.dx), sag.map(|c| c.dy));
            heights[i] = Lens.sag(Taylor(x[i]), Taylor(y[i])).0;
        }
        crate::registers::each_width(|registers| {
            let [mut found, mut found_x, mut found_y] = [(); 3].map(|()| blank.clone());
            let out = GradientSeries {
                z: &mut found,
                zx: &mut found_x,
                zy: &mut found_y,
            };
            registers.run(SlopesAlong::<_, N>::new(&Lens, (&x, &y), out));
            for (found, alone) in [(&found, &z), (&found_x, &zx), (&found_y, &zy)] {
                assert_eq!(bits(found, N), bits(alone, N), "{registers:?}, {N}");
            }
            for all in [&mut found, &mut found_x, &mut found_y] {
                all.clone_from(&blank);
            }
            let out = GradientSeries {
                z: &mut found,
                zx: &mut found_x,
                zy: &mut found_y,
            };
            registers.run(InLanes(SlopesAlong::<_, N>::new(&Lens, (&x, &y), out)));
            for (found, alone) in [(&found, &z), (&found_x, &zx), (&found_y, &zy)] {
                assert_eq!(bits(found, N), bits(alone, N), "{registers:?}, {N}, lanes");
            }
            let along = HeightsAlong::<_, N>::new(&Lens, (&x, &y), &mut found);
            registers.run(along);
            assert_eq!(bits(&found, N), bits(&heights, N), "{registers:?}, {N}");
            found.clone_from(&blank);
            let along = HeightsAlong::<_, N>::new(&Lens, (&x, &y), &mut found);
            registers.run(InLanes(along));
            assert_eq!(
                bits(&found, N),
                bits(&heights, N),
                "{registers:?}, {N}, lanes"
            );
        });
    }

    #[test]
    fn a_strip_has_the_bits_of_its_curves_alone_in_all_registers() {
        has_the_bits_of_curves_alone::<2>();
        has_the_bits_of_curves_alone::<3>();
        has_the_bits_of_curves_alone::<5>();
    }
}
