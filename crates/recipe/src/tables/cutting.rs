//! `[tolerance]` and `[spindle]`: how exactly, and how fast.

use turnpath_core::{Quantity, Tolerance};

use crate::read::{POSITIVE, Section};

pub(super) const TOLERANCE_KEYS: &[&str] = &["interpolation", "residual"];
pub(super) const SPINDLE_KEYS: &[&str] = &["speed"];

/// Reads `[tolerance]`.
pub(crate) fn tolerance(section: &mut Section<'_>) -> Option<Tolerance> {
    if section.table.is_none() {
        section.missing_table("interpolation = \"100 nm\"");
        return None;
    }
    section.only(TOLERANCE_KEYS);
    let mut length = |key| section.required_quantity(key, Quantity::Length, POSITIVE, "100 nm");
    let (interpolation, residual) = (length("interpolation"), length("residual"));
    Some(Tolerance {
        interpolation: interpolation?.value,
        residual: residual?.value,
    })
}

/// Reads `[spindle]`; the speed in rad/s.
pub(crate) fn spindle(section: &mut Section<'_>) -> Option<f64> {
    if section.table.is_none() {
        section.missing_table("speed = \"500 rpm\"");
        return None;
    }
    section.only(SPINDLE_KEYS);
    let speed = section.required_quantity("speed", Quantity::RotationSpeed, POSITIVE, "500 rpm");
    speed.map(|speed| speed.value)
}
