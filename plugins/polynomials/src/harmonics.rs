//! Sums over angles: Σ_m ρᵐ (cos mθ · Σ_k a_k p_k(w) + sin mθ · Σ_k b_k p_k(w)), w a function of ρ².
//!
//! ρᵐ cos mθ and ρᵐ sin mθ are the real and the imaginary part of (x + iy)ᵐ: polynomials in x and y.
//! So there is no angle, no root and no division, and the axis is a point like any other.

use turnpath_plugin::prelude::*;

use crate::recurrence::Family;

/// The terms of all m.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics(Vec<Harmonic>);

/// The terms of one m: the one of its place in the list.
#[derive(Debug, Clone, PartialEq)]
struct Harmonic {
    family: Family,
    /// a_0, a_1, …
    cosine: Vec<f64>,
    /// b_0, b_1, …
    sine: Vec<f64>,
}

/// One coefficient of a sum over angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngularTerm {
    /// k, the number of the radial polynomial.
    pub radial: usize,
    /// m; negative for sin |m|θ.
    pub order: i32,
    /// The coefficient, mm.
    pub coefficient: f64,
}

impl Harmonics {
    /// The sum of these terms; `family` gives the polynomials of an m and their number. Terms of one
    /// polynomial are added.
    pub fn new(terms: &[AngularTerm], family: impl Fn(usize, usize) -> Family) -> Self {
        let orders = terms.iter().map(|term| term.order.unsigned_abs() as usize);
        let count = orders.max().map_or(0, |highest| highest + 1);
        let harmonic = |order: usize| {
            let of = |sign: i32| coefficients(terms, order as i32 * sign);
            let (cosine, sine) = match order {
                0 => (of(1), Vec::new()),
                _ => (of(1), of(-1)),
            };
            Harmonic {
                family: family(order, cosine.len().max(sine.len())),
                cosine,
                sine,
            }
        };
        Self((0..count).map(harmonic).collect())
    }

    /// The same with the coefficients of each m replaced: `change` gives them from those there.
    pub fn changed(mut self, change: impl Fn(usize, &[f64]) -> Vec<f64>) -> Self {
        for (order, harmonic) in self.0.iter_mut().enumerate() {
            harmonic.cosine = change(order, &harmonic.cosine);
            harmonic.sine = change(order, &harmonic.sine);
        }
        self
    }

    /// The sum at (x, y).
    #[inline(always)]
    pub fn sum<S: Scalar>(&self, x: S, y: S, w: S) -> S {
        let mut total = S::constant(0.0);
        let mut turned = (S::constant(1.0), S::constant(0.0));
        for (order, harmonic) in self.0.iter().enumerate() {
            match order {
                0 => {}
                1 => turned = (x, y),
                _ => turned = (turned.0 * x - turned.1 * y, turned.0 * y + turned.1 * x),
            }
            if order == 0 {
                total = harmonic.family.sum(&harmonic.cosine, w);
            } else if harmonic.sine.is_empty() && !harmonic.cosine.is_empty() {
                total = total + turned.0 * harmonic.family.sum(&harmonic.cosine, w);
            } else if !harmonic.sine.is_empty() {
                let (cosine, sine) = harmonic.family.sums(&harmonic.cosine, &harmonic.sine, w);
                total = total + turned.0 * cosine + turned.1 * sine;
            }
        }
        total
    }
}

/// The coefficients of one order, by the number of their polynomials.
fn coefficients(terms: &[AngularTerm], order: i32) -> Vec<f64> {
    let mut dense = Vec::new();
    for term in terms.iter().filter(|term| term.order == order) {
        if dense.len() <= term.radial {
            dense.resize(term.radial + 1, 0.0);
        }
        dense[term.radial] += term.coefficient;
    }
    dense
}
