//! `[tolerance]` and `[spindle]`: how accurate the part must be, and how fast the spindle turns.

use std::f64::consts::TAU;

use turnpath_core::kind::{Length, RotationSpeed, Text};
use turnpath_core::{Param, Tolerance};

use crate::read::Section;
use crate::table_info::TableInfo;

/// The smallest tolerance, 0.001 nm in mm: ten times the rounding error of a metre in double
/// precision.
const MEASURABLE: f64 = 1e-9;
/// The slowest spindle, 1e-6 rpm in rad/s: one turn in two years.
const SLOWEST: f64 = 1e-6 * TAU / 60.0;
/// The fastest spindle, 1e6 rpm in rad/s: more than any spindle reaches.
const FASTEST: f64 = 1e6 * TAU / 60.0;

const INTERPOLATION: Param<Length> = Param::length(
    "interpolation",
    "largest distance of the played tool centre from the true one, along z",
)
.min(MEASURABLE)
.example("100 nm");
const RESIDUAL: Param<Length> = Param::length(
    "residual",
    "highest cusp between passes, along the profile's normal",
)
.min(MEASURABLE)
.example("100 nm");

/// The spindle strategy of a recipe that names none.
pub(crate) const DEFAULT_SPINDLE: &str = "constant";

const SPINDLE_USE: Param<Text> = Param::text(
    "use",
    "the spindle strategy, a name that `turnpath list spindle` shows",
)
.default(DEFAULT_SPINDLE);
const SPEED: Param<RotationSpeed> = Param::rotation_speed(
    "speed",
    "largest speed of the spindle, at most `c_velocity` of `[machine]`; a constant spindle turns at this \
     speed over the whole cut",
)
.min(SLOWEST)
.max(FASTEST)
.example("500 rpm");

pub(super) const TOLERANCE: TableInfo = TableInfo {
    name: "tolerance",
    summary: "how accurate the part must be",
    required: true,
    keys: &[INTERPOLATION.info(), RESIDUAL.info()],
};

pub(super) const SPINDLE: TableInfo = TableInfo {
    name: "spindle",
    summary: "how fast the spindle turns",
    required: true,
    keys: &[SPINDLE_USE.info(), SPEED.info()],
};

/// Reads `[tolerance]`.
pub(crate) fn tolerance(section: &mut Section<'_>) -> Option<Tolerance> {
    if !section.is_there(&TOLERANCE) {
        return None;
    }
    let params = section.bind(&TOLERANCE);
    Some(Tolerance {
        interpolation: params.find(INTERPOLATION)?,
        residual: params.find(RESIDUAL)?,
    })
}

/// Reads what belongs to the host in `[spindle]`: the speed in rad/s.
pub(crate) fn spindle(section: &mut Section<'_>) -> Option<f64> {
    if !section.is_there(&SPINDLE) {
        return None;
    }
    // The other keys belong to the strategy, if the recipe names one.
    match section.node(SPINDLE_USE.name()) {
        None => section.report_unknown_keys(&SPINDLE),
        Some(_) => section.report_misspelling(SPEED.name(), &SPINDLE),
    }
    section.values(&[SPEED.info()]).find(SPEED)
}
