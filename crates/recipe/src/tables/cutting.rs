//! `[tolerance]` and `[spindle]`: how accurate the part must be, and how fast the spindle turns.

use std::f64::consts::TAU;

use turnpath_core::{NM, Quantity, Tolerance};

use crate::read::{Bound, Section};

pub(super) const TOLERANCE_KEYS: &[&str] = &["interpolation", "residual"];
pub(super) const SPINDLE_KEYS: &[&str] = &["use", "speed"];

/// The smallest tolerance is ten times the rounding error of a metre in double precision.
const MEASURABLE: Bound = Bound {
    holds: |length| length >= 0.000_999 * NM,
    words: "0.001 nm or above",
};
/// From one turn in two years to more than any spindle reaches.
const SPINDLE_SPEED: Bound = Bound {
    holds: |speed| (0.999e-6..=1.001e6).contains(&(60.0 * speed / TAU)),
    words: "between 1e-6 rpm and 1e6 rpm",
};

/// Reads `[tolerance]`.
pub(crate) fn tolerance(section: &mut Section<'_>) -> Option<Tolerance> {
    if section.table.is_none() {
        section.missing_table("interpolation = \"100 nm\"");
        return None;
    }
    section.report_unknown_keys(TOLERANCE_KEYS);
    let mut length = |key| section.required_quantity(key, Quantity::Length, MEASURABLE, "100 nm");
    let (interpolation, residual) = (length("interpolation"), length("residual"));
    Some(Tolerance {
        interpolation: interpolation?.value,
        residual: residual?.value,
    })
}

/// Reads what belongs to the host in `[spindle]`: the speed in rad/s.
pub(crate) fn spindle(section: &mut Section<'_>) -> Option<f64> {
    if section.table.is_none() {
        section.missing_table("speed = \"500 rpm\"");
        return None;
    }
    // The other keys belong to the strategy, if the recipe names one.
    match section.node("use") {
        None => section.report_unknown_keys(SPINDLE_KEYS),
        Some(_) => section.report_misspelling("speed", SPINDLE_KEYS),
    }
    let speed =
        section.required_quantity("speed", Quantity::RotationSpeed, SPINDLE_SPEED, "500 rpm");
    speed.map(|speed| speed.value)
}
