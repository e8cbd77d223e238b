//! `[tolerance]` and `[spindle]`: how accurate the part must be, and how fast the spindle turns.

use std::f64::consts::TAU;

use turnpath_core::kind::{Length, RotationSpeed};
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

const SPEED: Param<RotationSpeed> = Param::rotation_speed(
    "speed",
    "speed of the spindle over the cut, at most `c_velocity` of `[machine]`",
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
    keys: &[SPEED.info()],
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

/// Reads `[spindle]`; the speed in rad/s.
pub(crate) fn spindle(section: &mut Section<'_>) -> Option<f64> {
    if !section.is_there(&SPINDLE) {
        return None;
    }
    section.bind(&SPINDLE).find(SPEED)
}
