//! The series of the spline along a curve.
//!
//! All are made through an order `TO` that the caller chooses. A term of order k begins with tᵏ, so
//! that terms of higher orders add nothing to the coefficients that are asked for.

use turnpath_plugin::prelude::{ORDER, Series};

use crate::basis::{self, SPLINES};
use crate::spline::{Lines, Spline, combine, dot};

/// The derivatives of a spline at a place, over their factorials: `terms[b][a]` is that of order a
/// along x and b along y, in cells.
type Terms = [[f64; SPLINES]; SPLINES];

impl Spline {
    /// The series of the height and of both slopes along the curve (x(t), y(t)), through the order
    /// `TO`.
    pub fn series<const TO: usize>(&self, x: &Series, y: &Series) -> [Series; 3] {
        let Some(terms) = self.at(x[0], y[0], terms::<TO>) else {
            return [[f64::NAN; ORDER + 1]; 3];
        };
        let [over_x, over_y] = self.per;
        let (powers_x, powers_y) = (powers::<TO>(x, over_x), powers::<TO>(y, over_y));
        let mut sums = [[0.0; ORDER + 1]; 3];
        for (b, of_y) in powers_y.iter().enumerate().take(TO + 1) {
            for (a, of_x) in powers_x.iter().enumerate().take(TO + 1 - b) {
                let product = product::<TO>(of_x, of_y, a, b);
                let factors = [
                    terms[b][a],
                    terms[b][a + 1] * (a + 1) as f64 * over_x,
                    terms[b + 1][a] * (b + 1) as f64 * over_y,
                ];
                for (sum, factor) in sums.iter_mut().zip(factors) {
                    for (sum, term) in sum.iter_mut().zip(&product) {
                        *sum += factor * term;
                    }
                }
            }
        }
        sums
    }

    /// The series of the height along the curve (x(t), y(t)), through the order `TO`.
    pub fn height_series<const TO: usize>(&self, x: &Series, y: &Series) -> Series {
        let Some(terms) = self.at(x[0], y[0], terms::<TO>) else {
            return [f64::NAN; ORDER + 1];
        };
        let (powers_x, powers_y) = (powers::<TO>(x, self.per[0]), powers::<TO>(y, self.per[1]));
        let mut sum = [0.0; ORDER + 1];
        for (b, of_y) in powers_y.iter().enumerate().take(TO + 1) {
            for (a, of_x) in powers_x.iter().enumerate().take(TO + 1 - b) {
                let product = product::<TO>(of_x, of_y, a, b);
                for (sum, term) in sum.iter_mut().zip(&product) {
                    *sum += terms[b][a] * term;
                }
            }
        }
        sum
    }
}

/// The terms of heights and of slopes through the order `TO`, and zeros.
fn terms<const TO: usize>(s: f64, t: f64, lines: &Lines<'_>) -> Terms {
    let (along_x, along_y) = (orders(s), orders(t));
    let mut terms = [[0.0; SPLINES]; SPLINES];
    for (b, (terms, weights)) in terms.iter_mut().zip(&along_y).enumerate().take(TO + 2) {
        let line = combine(lines, weights);
        for (term, weights) in terms.iter_mut().zip(&along_x).take(TO + 2 - b) {
            *term = dot(&line, weights);
        }
    }
    terms
}

/// The six splines and their derivatives.
fn orders(t: f64) -> [basis::Weights; SPLINES] {
    [
        basis::derivative::<0>(t),
        basis::derivative::<1>(t),
        basis::derivative::<2>(t),
        basis::derivative::<3>(t),
        basis::derivative::<4>(t),
        basis::derivative::<5>(t),
    ]
}

/// The powers of what a coordinate moves from its start, in cells. The power of order k begins with
/// tᵏ.
fn powers<const TO: usize>(curve: &Series, over: f64) -> [Series; ORDER + 1] {
    let mut powers = [[0.0; ORDER + 1]; ORDER + 1];
    powers[0][0] = 1.0;
    let mut step = curve.map(|c| c * over);
    step[0] = 0.0;
    for order in 1..=TO {
        powers[order] = product::<TO>(&powers[order - 1], &step, order - 1, 1);
    }
    powers
}

/// The product of two series that begin with tᵃ and tᵇ.
#[inline(always)]
fn product<const TO: usize>(one: &Series, other: &Series, a: usize, b: usize) -> Series {
    let mut product = [0.0; ORDER + 1];
    for i in a..=TO {
        for j in b..=TO - i.min(TO) {
            product[i + j] += one[i] * other[j];
        }
    }
    product
}
