//! The coefficients of a recipe as whole numbers and values.

use turnpath_plugin::prelude::*;

/// The normalisation radius of polynomials on a disc.
pub const NORMALIZATION_RADIUS: Param<Length> = Param::length(
    "normalization_radius",
    "radius at which the polynomials' own radius is 1",
)
.positive();

/// The whole numbers of each coefficient, and its value.
pub fn terms<const N: usize>(params: &Params, param: Param<Coefficients>) -> Vec<([i32; N], f64)> {
    let rows = params.get(param).iter();
    rows.filter_map(|row| {
        let (value, numbers) = row.split_last()?;
        let numbers: &[f64; N] = numbers.try_into().ok()?;
        Some((numbers.map(|number| number as i32), *value))
    })
    .collect()
}

/// A whole number from 0 up to a largest one.
///
/// # Errors
/// If it is not in that range; the message says `what` it is.
pub fn degree(
    param: Param<Coefficients>,
    what: &str,
    number: i32,
    largest: usize,
) -> Result<usize> {
    let known = usize::try_from(number).ok().filter(|n| *n <= largest);
    known.ok_or_else(|| {
        param.refused(format!(
            "the {what} {number} is not a whole number from 0 to {largest}"
        ))
    })
}
