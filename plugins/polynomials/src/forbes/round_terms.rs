//! The coefficients of a Q polynomial of revolution, one for each degree.

use turnpath_plugin::prelude::*;

use super::best_fit_sphere::LARGEST_DEGREE;
use crate::terms::{degree, terms};

/// The coefficients as the recipe has them.
pub const COEFFICIENTS: Param<Coefficients> =
    Param::length_coefficients("coefficients", 1, "a_n of Q_n under n, from 0 on")
        .example("{ 0 = \"2 um\", 1 = \"-150 nm\" }");

/// The coefficients from degree 0 on, mm; 0 where the recipe has none.
///
/// # Errors
/// If a degree is not a whole number from 0 to [`LARGEST_DEGREE`].
pub fn round_coefficients(params: &Params) -> Result<Vec<f64>> {
    let mut dense = Vec::new();
    for ([n], coefficient) in terms::<1>(params, COEFFICIENTS) {
        let n = degree(COEFFICIENTS, "degree", n, LARGEST_DEGREE)?;
        put(&mut dense, n, coefficient);
    }
    Ok(dense)
}

/// Puts the coefficient of a degree into its place; the list grows as far as it must.
pub fn put(dense: &mut Vec<f64>, degree: usize, coefficient: f64) {
    dense.resize(dense.len().max(degree + 1), 0.0);
    dense[degree] = coefficient;
}
