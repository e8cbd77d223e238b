//! What the dialects with polynomials share: a segment as a cubic in decimals, and the axes along cubics.
//! Writers use the one, and readers the other.

mod read;
mod write;

pub(crate) use read::{Cubic, CubicAxes};
pub(crate) use write::{COEFFICIENT_DECIMALS, Coefficients, coefficients};
