//! Formulas and native surfaces from parameters.

use turnpath_core::{NamedConstant, ParamValue, Params, Strategy, StrategyError};
use turnpath_formula::Formula;

/// Constants: name, value in mm and rad, power of a length.
pub type Given<'a> = &'a [(&'a str, f64, i32)];

/// The formula, or the reason why it is none.
pub fn made(z: &str, constants: Given<'_>) -> Result<Formula, StrategyError> {
    let constant = |(name, value, length_power): &(&str, f64, i32)| NamedConstant {
        name: (*name).to_owned(),
        value: *value,
        length_power: *length_power,
    };
    let mut params = Params::new();
    params.set("z", ParamValue::Text(z.to_owned()));
    let constants = constants.iter().map(constant).collect();
    params.set("constants", ParamValue::Constants(constants));
    Formula::new(&params)
}

/// The formula.
pub fn formula(z: &str, constants: Given<'_>) -> Formula {
    made(z, constants).unwrap_or_else(|error| panic!("{z}: {error}"))
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
