//! Formulas and native surfaces from parameters.

use std::sync::Arc;

use crate::models::model;
use turnpath_core::{NamedConstant, ParamValue, Params, Strategy, StrategyError, SurfaceModel};
use turnpath_formula::Formula;

/// Constants: name, value in mm and rad, power of a length.
pub type Given<'a> = &'a [(&'a str, f64, i32)];

/// The parameters of a formula.
fn params(z: &str, constants: Given<'_>) -> Params {
    let constant = |(name, value, length_power): &(&str, f64, i32)| NamedConstant {
        name: (*name).to_owned(),
        value: *value,
        length_power: *length_power,
    };
    let mut params = Params::new();
    params.set("z", ParamValue::Text(z.to_owned()));
    let constants = constants.iter().map(constant).collect();
    params.set("constants", ParamValue::Constants(constants));
    params
}

/// The formula, or the reason why it is none.
pub fn made(z: &str, constants: Given<'_>) -> Result<Formula, StrategyError> {
    Formula::new(&params(z, constants))
}

/// The formula, for one point at a time.
pub fn formula(z: &str, constants: Given<'_>) -> Formula {
    made(z, constants).unwrap_or_else(|error| panic!("{z}: {error}"))
}

/// The formula as a surface model, for batches.
pub fn surface(z: &str, constants: Given<'_>) -> Arc<dyn SurfaceModel> {
    model::<Formula>(&params(z, constants))
}

/// Points of a disc, the axis among them, away from lines of symmetry otherwise.
pub fn points(radius: f64) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0)];
    for i in 1..=12 {
        for k in 0..17 {
            let angle = 0.37 * f64::from(k) + 0.11 * f64::from(i);
            let rho = radius * f64::from(i) / 12.0;
            let (sin, cos) = libm::sincos(angle);
            points.push((rho * cos, rho * sin));
        }
    }
    points
}
