//! Surface models: the formula that an author writes, and the batches that everything else uses.

mod columns;
mod curves;
mod formula;
mod points;

use serde::{Deserialize, Serialize};

use crate::orders::SeriesOrders;
use crate::registers::{LaneLoop, Loop, OneByOne, in_widest, lanes_in_widest};
use crate::{ORDER, Result, Series, StrategyError};
use curves::{HeightsAlong, InLanes, SlopesAlong};
use points::{Heights, Slopes};

pub use columns::{GradientSeries, Gradients};
pub use formula::{Surface, SurfaceGap};

/// A surface as its users call it: object-safe and in batches. Every [`Surface`] is a
/// `SurfaceModel`.
///
/// All slices of one call have the same length. NaN marks a point at which the surface has no
/// value.
pub trait SurfaceModel: Send + Sync {
    /// z at each (x, y).
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()>;
    /// z and its slopes at each (x, y).
    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()>;
    /// The series of z and of its slopes along the curves (x(t), y(t)).
    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()>;
    /// The series of z alone along the curves (x(t), y(t)).
    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()>;

    /// The same as [`series`](SurfaceModel::series) through the orders that the caller needs, with
    /// the same bits. Coefficients of higher orders may have any value. The default gives all
    /// orders.
    fn series_to(
        &self,
        orders: SeriesOrders,
        x: &[Series],
        y: &[Series],
        out: GradientSeries<'_>,
    ) -> Result<()> {
        let _ = orders;
        self.series(x, y, out)
    }

    /// The same as [`height_series`](SurfaceModel::height_series) through this order, with the same
    /// bits. Coefficients of higher orders may have any value. The default gives all orders.
    fn height_series_to(
        &self,
        order: usize,
        x: &[Series],
        y: &[Series],
        z: &mut [Series],
    ) -> Result<()> {
        let _ = order;
        self.height_series(x, y, z)
    }

    /// How far each (x, y) lies beyond the data that the surface was made from, mm: 0 where there
    /// are data. A formula has no data, and gives 0 everywhere, which is the default.
    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        let _ = (x, y);
        distance.fill(0.0);
        Ok(())
    }

    /// The data that the surface was made from; `None` for a formula, which is the default.
    fn data(&self) -> Result<Option<SurfaceData>> {
        Ok(None)
    }

    /// Why there is no height or no slope at (x, y), if a part of a parameter's text says so; `None`
    /// otherwise, which is the default.
    fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> {
        let _ = (x, y);
        Ok(None)
    }
}

/// What a surface was made from, for reports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceData {
    /// Points of the data, with those that have no height.
    pub points: u64,
    /// Points that have no height in the data and were filled.
    pub filled: u64,
    /// How the surface goes on beyond the data, in a few words.
    pub continuation: String,
    /// The largest distance along z that was found between the surface and the function that it
    /// stands for, mm; `None` for measured data. Plugins that were built before do not give it.
    #[serde(default)]
    pub fit_error: Option<f64>,
}

impl<T: Surface> SurfaceModel for T {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), &[y.len(), z.len()])?;
        over_points::<T, _>(Heights(self, x, y, z));
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        let Gradients { z, zx, zy } = &out;
        same_lengths(x.len(), &[y.len(), z.len(), zx.len(), zy.len()])?;
        over_points::<T, _>(Slopes(self, x, y, out));
        Ok(())
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        same_lengths(x.len(), &[y.len(), out.z.len(), out.zx.len(), out.zy.len()])?;
        slopes_along(SlopesAlong::<T, { ORDER + 1 }>::new(self, (x, y), out));
        Ok(())
    }

    fn series_to(
        &self,
        orders: SeriesOrders,
        x: &[Series],
        y: &[Series],
        out: GradientSeries<'_>,
    ) -> Result<()> {
        let GradientSeries { z, zx, zy } = out;
        same_lengths(x.len(), &[y.len(), z.len(), zx.len(), zy.len()])?;
        let out = GradientSeries { z: &mut *z, zx, zy };
        match orders.slopes {
            0 | 1 => slopes_along(SlopesAlong::<T, 2>::new(self, (x, y), out)),
            2 => slopes_along(SlopesAlong::<T, 3>::new(self, (x, y), out)),
            _ => return self.series(x, y, out),
        }
        match orders.heights > orders.slopes {
            true => self.height_series(x, y, z),
            false => Ok(()),
        }
    }

    fn height_series_to(
        &self,
        order: usize,
        x: &[Series],
        y: &[Series],
        z: &mut [Series],
    ) -> Result<()> {
        if order > 2 {
            return self.height_series(x, y, z);
        }
        same_lengths(x.len(), &[y.len(), z.len()])?;
        heights_along(HeightsAlong::<T, 3>::new(self, (x, y), z));
        Ok(())
    }

    fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> {
        Ok(Surface::gap(self, x, y))
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        same_lengths(x.len(), &[y.len(), z.len()])?;
        heights_along(HeightsAlong::<T, { ORDER + 1 }>::new(self, (x, y), z));
        Ok(())
    }
}

/// Runs a loop over points.
fn over_points<T: Surface, L: LaneLoop>(one: L) -> L::Output {
    // What a constant block rules out is not compiled.
    if const { !T::IN_WIDE_REGISTERS } {
        one.one_by_one()
    } else if const { T::SIDE_BY_SIDE } {
        in_widest(OneByOne(one))
    } else {
        lanes_in_widest(one)
    }
}

/// Gives curves their heights.
fn heights_along<T: Surface, const N: usize>(along: HeightsAlong<'_, T, N>) {
    if const { !T::IN_WIDE_REGISTERS } {
        along.call();
    } else if const { T::SIDE_BY_SIDE } {
        in_widest(along);
    } else if const { N <= T::HEIGHT_COEFFICIENTS_IN_LANES } {
        lanes_in_widest(InLanes(along));
    } else {
        along.call();
    }
}

/// Gives curves their heights and slopes.
fn slopes_along<T: Surface, const N: usize>(along: SlopesAlong<'_, T, N>) {
    if const { !T::IN_WIDE_REGISTERS } {
        along.call();
    } else if const { T::SIDE_BY_SIDE } {
        in_widest(along);
    } else if const { N <= T::SLOPE_COEFFICIENTS_IN_LANES } {
        lanes_in_widest(InLanes(along));
    } else {
        along.call();
    }
}

fn same_lengths(points: usize, others: &[usize]) -> Result<()> {
    match others.iter().find(|length| **length != points) {
        None => Ok(()),
        Some(length) => Err(StrategyError::failed(format!(
            "a batch of {points} points came with a slice of length {length}"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scalar;

    struct Ripple;

    impl Surface for Ripple {
        // So its points go in lanes.
        const SIDE_BY_SIDE: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            (x * 3.0).sin() * y.squared() + x
        }
    }

    #[test]
    fn any_length_of_batch_gives_what_single_points_give() {
        let x: Vec<f64> = (0..19).map(|i| 0.1 * f64::from(i)).collect();
        let y: Vec<f64> = x.iter().map(|x| 1.0 - x).collect();
        for length in 0..x.len() {
            let mut z = vec![0.0; length];
            SurfaceModel::heights(&Ripple, &x[..length], &y[..length], &mut z).unwrap();
            for i in 0..length {
                assert_eq!(z[i].to_bits(), Surface::sag(&Ripple, x[i], y[i]).to_bits());
            }
        }
    }

    #[test]
    fn gradient_is_the_closed_form() {
        let (x, y) = ([0.25; 9], [2.0; 9]);
        let (mut z, mut zx, mut zy) = ([0.0; 9], [0.0; 9], [0.0; 9]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        Ripple.gradient(&x, &y, out).unwrap();
        let (sin, cos) = Scalar::sin_cos(0.75);
        assert_eq!(z, [4.0 * sin + 0.25; 9]);
        assert_eq!(zx, [12.0 * cos + 1.0; 9]);
        assert_eq!(zy, [4.0 * sin; 9]);
    }

    #[test]
    fn slices_of_unequal_length_are_an_error() {
        let error =
            SurfaceModel::heights(&Ripple, &[1.0; 3], &[1.0; 2], &mut [0.0; 3]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a batch of 3 points came with a slice of length 2"
        );
    }

    /// A formula with every kind of operation: roots, quotients, waves, powers and choices.
    struct Mixture;

    impl Surface for Mixture {
        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = x.squared() + y.squared() * 1.3 + 0.7;
            let root = (square * 0.4 + 2.0).sqrt() + x * 0.1;
            let wave = (x * 3.0).sin() * (y * 0.5).exp() + y.atan2(x + 9.0);
            let chosen = x.min(y) + square.ln() * x.powi(3) + square.powf(0.7);
            square / root + wave.tanh() + chosen - (x - y).tan().squared()
        }
    }

    /// [`Mixture`] without wide registers.
    struct Narrow;

    impl Surface for Narrow {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            Mixture.sag(x, y)
        }
    }

    /// Heights and slopes at points, one column each.
    fn gradients(surface: &dyn SurfaceModel, x: &[f64], y: &[f64]) -> [Vec<f64>; 3] {
        let mut all = [(); 3].map(|()| vec![f64::NAN; x.len()]);
        let [z, zx, zy] = &mut all;
        surface.gradient(x, y, Gradients { z, zx, zy }).unwrap();
        all
    }

    #[test]
    fn a_formula_without_wide_registers_has_the_bits_of_one_with_them() {
        let x: Vec<f64> = (0..19).map(|i| 0.13 * f64::from(i) - 1.0).collect();
        let y: Vec<f64> = x.iter().map(|x| 0.7 - x).collect();
        let bits = |columns: &[Vec<f64>]| -> Vec<u64> {
            columns.iter().flatten().map(|z| z.to_bits()).collect()
        };
        let wide = gradients(&Mixture, &x, &y);
        assert_eq!(bits(&gradients(&Narrow, &x, &y)), bits(&wide));
        for surface in [&Mixture as &dyn SurfaceModel, &Narrow] {
            let mut z = vec![f64::NAN; x.len()];
            surface.heights(&x, &y, &mut z).unwrap();
            assert_eq!(bits(&[z]), bits(&wide[..1]));
        }
        let (along_x, along_y) = curves(29);
        let wide = all_orders(&Mixture, &along_x, &along_y);
        for (one, other) in all_orders(&Narrow, &along_x, &along_y).iter().zip(&wide) {
            same(one, other, ORDER);
        }
        fewer_orders_have_the_bits_of_all_orders(&Narrow);
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn points_have_the_bits_of_each_alone_in_all_registers() {
        let x: Vec<f64> = (0..19).map(|i| 0.13 * f64::from(i) - 1.0).collect();
        let y: Vec<f64> = x.iter().map(|x| 0.7 - x).collect();
        let alone = gradients(&Narrow, &x, &y);
        crate::registers::each_width(|registers| {
            let [mut heights, mut z, mut zx, mut zy] = [(); 4].map(|()| vec![f64::NAN; x.len()]);
            registers.run_lanes(Heights(&Mixture, &x, &y, &mut heights));
            let out = Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            registers.run_lanes(Slopes(&Mixture, &x, &y, out));
            assert_eq!(heights, alone[0], "{registers:?}");
            assert_eq!([z, zx, zy], alone, "{registers:?}");
            let [mut heights, mut z, mut zx, mut zy] = [(); 4].map(|()| vec![f64::NAN; x.len()]);
            registers.run(OneByOne(Heights(&Mixture, &x, &y, &mut heights)));
            let out = Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            registers.run(OneByOne(Slopes(&Mixture, &x, &y, out)));
            assert_eq!(heights, alone[0], "{registers:?}, one by one");
            assert_eq!([z, zx, zy], alone, "{registers:?}, one by one");
        });
    }

    fn curves(count: usize) -> (Vec<Series>, Vec<Series>) {
        let series = |i: usize| {
            let t = i as f64;
            let x = [0.3 * t - 1.0, 1.0, -0.2 * t, 0.05, 0.01];
            (x, [0.9 - 0.2 * t, 0.4 + t, 0.3, -0.1 * t, 0.02])
        };
        (0..count).map(series).unzip()
    }

    fn same(one: &[Series], other: &[Series], order: usize) {
        let bits = |all: &[Series]| -> Vec<u64> {
            all.iter()
                .flat_map(|c| &c[..=order])
                .map(|c| c.to_bits())
                .collect()
        };
        assert_eq!(bits(one), bits(other), "order {order}");
    }

    /// Series of heights and of both slopes, with all orders.
    fn all_orders<T: Surface>(surface: &T, x: &[Series], y: &[Series]) -> [Vec<Series>; 3] {
        let mut all = [(); 3].map(|()| vec![[f64::NAN; 5]; x.len()]);
        let [z, zx, zy] = &mut all;
        SurfaceModel::series(surface, x, y, GradientSeries { z, zx, zy }).unwrap();
        all
    }

    fn fewer_orders_have_the_bits_of_all_orders<T: Surface>(surface: &T) {
        for count in 0..10 {
            let (x, y) = curves(count);
            let blank = vec![[f64::NAN; 5]; count];
            let [z, zx, zy] = all_orders(surface, &x, &y);
            for (heights, slopes) in [(0, 0), (1, 1), (2, 1), (4, 1), (2, 2), (4, 2), (4, 4)] {
                let [mut low, mut low_x, mut low_y] = [(); 3].map(|()| blank.clone());
                let out = GradientSeries {
                    z: &mut low,
                    zx: &mut low_x,
                    zy: &mut low_y,
                };
                let orders = SeriesOrders { heights, slopes };
                surface.series_to(orders, &x, &y, out).unwrap();
                same(&low, &z, heights);
                same(&low_x, &zx, slopes);
                same(&low_y, &zy, slopes);
            }
            for order in 0..5 {
                let mut low = blank.clone();
                surface.height_series_to(order, &x, &y, &mut low).unwrap();
                same(&low, &z, order);
            }
        }
    }

    #[test]
    fn fewer_orders_have_the_bits_of_all_orders_in_batches_of_any_length() {
        fewer_orders_have_the_bits_of_all_orders(&Mixture);
        fewer_orders_have_the_bits_of_all_orders(&Polynomial::<true>);
        fewer_orders_have_the_bits_of_all_orders(&Polynomial::<false>);
    }

    /// A formula with a loop. Its series go side by side, or in lanes and one by one.
    struct Polynomial<const SIDE_BY_SIDE: bool>;

    impl<const SIDE_BY_SIDE: bool> Surface for Polynomial<SIDE_BY_SIDE> {
        const SIDE_BY_SIDE: bool = SIDE_BY_SIDE;

        #[inline(always)]
        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let (mut power, mut sum) = (x, x * y);
            for term in 1..6 {
                power = power * (x - y * 0.3);
                sum = sum + power * (0.7 / f64::from(term));
            }
            sum
        }
    }

    #[test]
    fn series_in_lanes_and_one_by_one_have_the_bits_of_series_side_by_side() {
        let (x, y) = curves(29);
        let side_by_side = all_orders(&Polynomial::<true>, &x, &y);
        let others = all_orders(&Polynomial::<false>, &x, &y);
        for (one, other) in side_by_side.iter().zip(&others) {
            same(one, other, ORDER);
        }
        let [mut heights, mut slopes_x, mut slopes_y] = [(); 3].map(|()| vec![[f64::NAN; 5]; 29]);
        let lanes = &Polynomial::<false>;
        lanes.height_series(&x, &y, &mut heights).unwrap();
        same(&heights, &side_by_side[0], ORDER);
        let out = GradientSeries {
            z: &mut heights,
            zx: &mut slopes_x,
            zy: &mut slopes_y,
        };
        let orders = SeriesOrders {
            heights: 2,
            slopes: 2,
        };
        lanes.series_to(orders, &x, &y, out).unwrap();
        for (one, other) in [heights, slopes_x, slopes_y].iter().zip(&side_by_side) {
            same(one, other, 2);
        }
    }
}
