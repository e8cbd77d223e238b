//! Nose centres by opencamlib's drop-cutter (`tests/reference/dropcutter.py`), for whichever test
//! includes this file with `#[path]`, and `models.rs` as the module `models`.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use serde_json::Value;
use turnpath_core::{Misfit, ParamValue, Params, SurfaceModel, Tool};
// A plugin that nothing names is dropped by the linker.
use turnpath_surfaces as _;

use crate::models::try_model;

const REFERENCE: &str = include_str!("../reference/dropcutter.json");

/// One angle of one part.
pub struct Case {
    /// Surface, parameters and angle, for messages.
    pub name: String,
    pub surface: Arc<dyn SurfaceModel>,
    pub aperture_radius: f64,
    pub tool: Tool,
    /// Whether the nose fits into every hollow.
    pub fits: bool,
    /// The C angle of every place, as long as `x`.
    pub theta: Vec<f64>,
    /// X of the centre, mm.
    pub x: Vec<f64>,
    /// Z of the centre as the drop-cutter found it, mm.
    pub z_centre: Vec<f64>,
    /// The largest error of `z_centre`, mm: the mesh's own error and rounding.
    pub stated_error: f64,
}

impl Case {
    /// Holds every height against the drop-cutter's.
    pub fn assert_agrees(&self, found: impl ExactSizeIterator<Item = f64>) {
        assert_eq!(found.len(), self.x.len(), "{}", self.name);
        for (found, (x, exact)) in found.zip(self.x.iter().zip(&self.z_centre)) {
            let error = found - exact;
            assert!(
                error.abs() <= self.stated_error,
                "{}, X = {x}: {found}, drop-cutter {exact}, off by {error:e} of {:e} mm",
                self.name,
                self.stated_error
            );
        }
    }
}

/// All angles of all parts.
pub fn cases() -> Vec<Case> {
    let reference: Value = serde_json::from_str(REFERENCE).unwrap();
    reference["cases"]
        .as_array()
        .unwrap()
        .iter()
        .map(case)
        .collect()
}

fn case(value: &Value) -> Case {
    let number = |key: &str| value[key].as_f64().unwrap();
    let numbers = |key: &str| serde_json::from_value(value[key].clone()).unwrap();
    let (surface, given) = (value["surface"].as_str().unwrap(), &value["parameters"]);
    let (theta, x): (f64, Vec<f64>) = (number("theta"), numbers("x"));
    let fits = value["fits"].as_bool().unwrap();
    Case {
        name: format!("{surface} {given} at {theta} rad"),
        surface: try_model(surface, &params(given)).unwrap(),
        aperture_radius: number("aperture_radius_mm"),
        tool: Tool {
            nose_radius: value["tool"]["nose_radius_mm"].as_f64().unwrap(),
            included_angle: None,
            clearance_angle: None,
            misfit: match fits {
                true => Misfit::Refuse,
                false => Misfit::CutWhatFits,
            },
        },
        fits,
        theta: vec![theta; x.len()],
        x,
        z_centre: numbers("z_centre"),
        stated_error: number("mesh_error_mm") + number("rounding_mm"),
    }
}

fn params(given: &Value) -> Params {
    let mut params = Params::new();
    for (name, value) in given.as_object().unwrap() {
        let value = match value {
            Value::String(word) => ParamValue::Text(word.clone()),
            Value::Array(_) => ParamValue::Rows(serde_json::from_value(value.clone()).unwrap()),
            _ => ParamValue::Number(value.as_f64().unwrap()),
        };
        params.set(name, value);
    }
    params
}
