//! Surfaces from the parameters of a recipe.

use turnpath_core::{ParamValue, Params, StrategyError, Surface};

/// Coefficients under their whole numbers.
pub fn coefficients<const N: usize>(terms: &[([i32; N], f64)]) -> ParamValue {
    let row = |(numbers, value): &([i32; N], f64)| {
        let numbers = numbers.iter().map(|number| f64::from(*number));
        numbers.chain([*value]).collect()
    };
    ParamValue::Rows(terms.iter().map(row).collect())
}

/// Parameters with these coefficients and a normalisation radius of 1 mm.
pub fn on_unit_disc<const N: usize>(terms: &[([i32; N], f64)]) -> Params {
    let mut params = Params::new().with("normalization_radius", 1.0);
    params.set("coefficients", coefficients(terms));
    params
}

/// The parameters of Zernike polynomials of one convention.
pub fn zernike(indexing: &str, normalization: Option<&str>, terms: &[([i32; 1], f64)]) -> Params {
    let mut params = on_unit_disc(terms);
    let text = |word: &str| ParamValue::Text(word.to_owned());
    params.set("indexing", text(indexing));
    if let Some(normalization) = normalization {
        params.set("normalization", text(normalization));
    }
    params
}

/// The height at ρ and θ.
pub fn height(surface: &impl Surface, rho: f64, theta: f64) -> f64 {
    let (sin, cos) = turnpath_core::Scalar::sin_cos(theta);
    surface.sag(rho * cos, rho * sin)
}

/// The message of a strategy that refuses its parameters.
pub fn refusal<T: std::fmt::Debug>(made: Result<T, StrategyError>) -> String {
    made.unwrap_err().to_string()
}
