//! The series of the spline along curves.
//!
//! All are made through an order `TO` that the caller chooses. A term of order k begins with tᵏ, so
//! that terms of higher orders add nothing to the coefficients that are asked for. The curves of a group
//! go side by side.

use turnpath_plugin::prelude::{GradientSeries, ORDER, Series};
use turnpath_plugin::registers::Loop;

use crate::basis::{NO_WEIGHTS, SPLINES, Weights, derivative};
use crate::spline::{NO_PATCH, Spline, combine, dot};

/// Curves of a group. With more of them, their numbers leave the cache of the first level.
const GROUP: usize = 8;

/// A number of each curve.
type Numbers = [f64; GROUP];

/// The derivatives of a spline at places, over their factorials: `terms[b][a]` is that of order a
/// along x and b along y, in cells.
type Terms = [[Numbers; SPLINES]; SPLINES];

/// The series of the curves, order by order.
type Orders = [Numbers; ORDER + 1];

/// Series before anything is added.
const NOTHING: Orders = [[0.0; GROUP]; ORDER + 1];

/// The loop that gives curves the series of their heights, through the order `TO`. All slices have one
/// length.
pub struct HeightsAlong<'a, const TO: usize> {
    /// The spline.
    pub spline: &'a Spline,
    /// x(t) of the curves, mm.
    pub x: &'a [Series],
    /// y(t) of the curves, mm.
    pub y: &'a [Series],
    /// Their heights, mm.
    pub z: &'a mut [Series],
}

impl<const TO: usize> Loop for HeightsAlong<'_, TO> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { spline, x, y, z } = self;
        let curves = x.chunks(GROUP).zip(y.chunks(GROUP));
        for ((x, y), z) in curves.zip(z.chunks_mut(GROUP)) {
            let terms = terms::<TO>(spline, x, y);
            let (of_x, of_y) = (
                powers::<TO>(x, spline.per[0]),
                powers::<TO>(y, spline.per[1]),
            );
            let mut height = NOTHING;
            for b in 0..=TO {
                for a in 0..=TO - b {
                    let product = product::<TO>(&of_x[a], &of_y[b], a, b);
                    add::<TO>(&mut height, &terms[b][a], &product, a + b);
                }
            }
            put(&height, z);
        }
    }
}

/// The loop that gives curves the series of their heights and of both slopes, through the order `TO`. All
/// slices have one length.
pub struct SlopesAlong<'a, const TO: usize> {
    /// The spline.
    pub spline: &'a Spline,
    /// x(t) of the curves, mm.
    pub x: &'a [Series],
    /// y(t) of the curves, mm.
    pub y: &'a [Series],
    /// Their heights, mm, and slopes.
    pub out: GradientSeries<'a>,
}

impl<const TO: usize> Loop for SlopesAlong<'_, TO> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { spline, x, y, out } = self;
        let GradientSeries { z, zx, zy } = out;
        let [per_x, per_y] = spline.per;
        let curves = x.chunks(GROUP).zip(y.chunks(GROUP));
        let slopes = zx.chunks_mut(GROUP).zip(zy.chunks_mut(GROUP));
        for (((x, y), z), (zx, zy)) in curves.zip(z.chunks_mut(GROUP)).zip(slopes) {
            let terms = terms::<TO>(spline, x, y);
            let (of_x, of_y) = (powers::<TO>(x, per_x), powers::<TO>(y, per_y));
            let [mut height, mut slope_x, mut slope_y] = [NOTHING; 3];
            for b in 0..=TO {
                for a in 0..=TO - b {
                    let product = product::<TO>(&of_x[a], &of_y[b], a, b);
                    let along_x = terms[b][a + 1].map(|term| term * (a + 1) as f64 * per_x);
                    let along_y = terms[b + 1][a].map(|term| term * (b + 1) as f64 * per_y);
                    add::<TO>(&mut height, &terms[b][a], &product, a + b);
                    add::<TO>(&mut slope_x, &along_x, &product, a + b);
                    add::<TO>(&mut slope_y, &along_y, &product, a + b);
                }
            }
            put(&height, z);
            put(&slope_x, zx);
            put(&slope_y, zy);
        }
    }
}

/// The terms of heights and of slopes where curves begin, through the order `TO`, and zeros.
#[inline(always)]
fn terms<const TO: usize>(spline: &Spline, x: &[Series], y: &[Series]) -> Terms {
    let mut patch = NO_PATCH;
    let mut terms = [[[0.0; GROUP]; SPLINES]; SPLINES];
    for (i, (x, y)) in x.iter().zip(y).enumerate().take(GROUP) {
        let place = spline.place(x[0], y[0]);
        let (along_x, along_y) = (orders::<TO>(place.s), orders::<TO>(place.t));
        let lines = spline.lines(&place, &mut patch);
        for (b, (terms, of_y)) in terms.iter_mut().zip(&along_y).enumerate().take(TO + 2) {
            let line = combine(&lines, of_y);
            for (term, of_x) in terms.iter_mut().zip(&along_x).take(TO + 2 - b) {
                term[i] = dot(&line, of_x);
            }
        }
    }
    terms
}

/// The six splines and their derivatives through the order `TO` + 1, and zeros.
#[inline(always)]
fn orders<const TO: usize>(t: f64) -> [Weights; SPLINES] {
    let mut orders = [NO_WEIGHTS; SPLINES];
    orders[0] = derivative::<0>(t);
    orders[1] = derivative::<1>(t);
    orders[2] = derivative::<2>(t);
    if TO > 1 {
        orders[3] = derivative::<3>(t);
    }
    if TO > 2 {
        orders[4] = derivative::<4>(t);
        orders[5] = derivative::<5>(t);
    }
    orders
}

/// The powers of what a coordinate moves from its start, in cells. The power of order k begins with
/// tᵏ.
#[inline(always)]
fn powers<const TO: usize>(curves: &[Series], over: f64) -> [Orders; ORDER + 1] {
    let mut step = NOTHING;
    for (i, curve) in curves.iter().enumerate().take(GROUP) {
        for (step, c) in step.iter_mut().zip(curve).skip(1) {
            step[i] = c * over;
        }
    }
    let mut powers = [NOTHING; ORDER + 1];
    powers[0][0] = [1.0; GROUP];
    for order in 1..=TO {
        powers[order] = product::<TO>(&powers[order - 1], &step, order - 1, 1);
    }
    powers
}

/// The products of two series that begin with tᵃ and tᵇ.
#[inline(always)]
fn product<const TO: usize>(one: &Orders, other: &Orders, a: usize, b: usize) -> Orders {
    let mut product = NOTHING;
    for i in a..=TO {
        for j in b..=TO - i.min(TO) {
            for (k, sum) in product[i + j].iter_mut().enumerate() {
                *sum += one[i][k] * other[j][k];
            }
        }
    }
    product
}

/// Adds the multiples of a product, which begins with the order `first`.
#[inline(always)]
fn add<const TO: usize>(sum: &mut Orders, factors: &Numbers, product: &Orders, first: usize) {
    for (sum, product) in sum.iter_mut().zip(product).take(TO + 1).skip(first) {
        for ((sum, factor), product) in sum.iter_mut().zip(factors).zip(product) {
            *sum += factor * product;
        }
    }
}

/// Puts the numbers of the curves into their series.
#[inline(always)]
fn put(orders: &Orders, curves: &mut [Series]) {
    for (i, curve) in curves.iter_mut().enumerate().take(GROUP) {
        for (coefficient, numbers) in curve.iter_mut().zip(orders) {
            *coefficient = numbers[i];
        }
    }
}

#[cfg(test)]
impl Spline {
    /// The series of the height and of both slopes along one curve.
    pub fn series<const TO: usize>(&self, x: &Series, y: &Series) -> [Series; 3] {
        let [mut z, mut zx, mut zy] = [[[f64::NAN; ORDER + 1]]; 3];
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        let (spline, x, y) = (self, &[*x], &[*y]);
        SlopesAlong::<TO> { spline, x, y, out }.call();
        [z[0], zx[0], zy[0]]
    }

    /// The series of the height along one curve.
    pub fn height_series<const TO: usize>(&self, x: &Series, y: &Series) -> Series {
        let mut z = [[f64::NAN; ORDER + 1]];
        HeightsAlong::<TO> {
            spline: self,
            x: &[*x],
            y: &[*y],
            z: &mut z,
        }
        .call();
        z[0]
    }
}
