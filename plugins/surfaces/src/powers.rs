//! Aspheric terms: coefficients under powers, as the design programs have them.

use turnpath_plugin::prelude::*;

/// Largest power of an aspheric term: twice that of the design programs.
pub const LARGEST_POWER: usize = 40;

/// The coefficients of the powers from 0 up to the highest that is given; 0 where none is.
///
/// # Errors
/// If a power is not from `least` to [`LARGEST_POWER`] in steps of `step`.
pub fn dense(
    params: &Params,
    terms: Param<Option<Coefficients>>,
    least: usize,
    step: usize,
) -> Result<Vec<f64>> {
    let mut dense: Vec<f64> = Vec::new();
    for row in params.get(terms).unwrap_or_default() {
        let [power, coefficient] = row[..] else {
            return Err(terms.refused("a coefficient has one power and one value"));
        };
        let known = (least..=LARGEST_POWER)
            .step_by(step)
            .find(|known| *known as f64 == power);
        let Some(power) = known else {
            let even = if step == 2 { "an even" } else { "a" };
            return Err(terms.refused(format!(
                "the power {power} is not {even} whole number from {least} to {LARGEST_POWER}"
            )));
        };
        if dense.len() <= power {
            dense.resize(power + 1, 0.0);
        }
        dense[power] = coefficient;
    }
    Ok(dense)
}

/// Every second coefficient, from the power `first` on.
pub fn every_second(dense: &[f64], first: usize) -> Vec<f64> {
    dense.iter().skip(first).step_by(2).copied().collect()
}

/// Σ c_k·sᵏ, by Horner's rule.
#[inline(always)]
pub fn sum<S: Scalar>(coefficients: &[f64], s: S) -> S {
    match coefficients {
        [] => S::constant(0.0),
        [constant] => S::constant(*constant),
        [lower @ .., next, highest] => {
            // A `fold` may become a function of its own, which knows no wide registers.
            let mut sum = s * *highest + *next;
            for c in lower.iter().rev() {
                sum = sum * s + *c;
            }
            sum
        }
    }
}
