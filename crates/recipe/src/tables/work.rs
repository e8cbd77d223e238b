//! `[part]` and `[tool]`: the part and the tool that cuts it.

use std::f64::consts::PI;

use turnpath_core::{Misfit, Part, Quantity, Tool};

use crate::diagnostic::Diagnostic;
use crate::read::{Bound, NOT_NEGATIVE, Section};

pub(super) const PART_KEYS: &[&str] = &["aperture", "inner"];
pub(super) const TOOL_KEYS: &[&str] = &[
    "nose_radius",
    "included_angle",
    "clearance_angle",
    "interference",
];

/// The smallest length of a part or a tool that can be made.
const LEAST_LENGTH: Bound = Bound {
    holds: |length| length >= 0.999e-4,
    words: "0.1 um or above",
};
const INCLUDED: Bound = Bound {
    holds: |angle| angle > 0.0 && angle <= PI,
    words: "above zero and at most 180 deg",
};
const CLEARANCE: Bound = Bound {
    holds: |angle| angle > 0.0 && angle < 0.5 * PI,
    words: "between 0 and 90 deg",
};

/// Reads `[part]`.
pub(crate) fn part(section: &mut Section<'_>) -> Option<Part> {
    if section.table.is_none() {
        section.missing_table("aperture = \"5 mm\"");
        return None;
    }
    section.report_unknown_keys(PART_KEYS);
    let aperture = section.required_quantity("aperture", Quantity::Length, LEAST_LENGTH, "5 mm");
    let inner = section.quantity("inner", Quantity::Length, NOT_NEGATIVE);
    let (aperture, hole) = (aperture?, inner.as_ref().map_or(0.0, |inner| inner.value));
    if let Some(inner) = inner.filter(|inner| inner.value >= aperture.value) {
        let whole = Quantity::Length.format(aperture.value);
        let diagnostic = Diagnostic::new(inner.span, "the hole is not smaller than the aperture")
            .with_label(format!("must be below {whole}"))
            .with_help("`inner` is the diameter of the hole, `aperture` that of the part");
        section.report(diagnostic);
        return None;
    }
    Some(Part {
        aperture_radius: 0.5 * aperture.value,
        inner_radius: 0.5 * hole,
    })
}

/// Reads `[tool]`.
pub(crate) fn tool(section: &mut Section<'_>) -> Option<Tool> {
    if section.table.is_none() {
        section.missing_table("nose_radius = \"1 mm\"");
        return None;
    }
    section.report_unknown_keys(TOOL_KEYS);
    let radius = section.required_quantity("nose_radius", Quantity::Length, LEAST_LENGTH, "1 mm");
    let included = section.quantity("included_angle", Quantity::Angle, INCLUDED);
    let clearance = section.quantity("clearance_angle", Quantity::Angle, CLEARANCE);
    let misfit = misfit(section);
    Some(Tool {
        nose_radius: radius?.value,
        included_angle: included.map(|angle| angle.value),
        clearance_angle: clearance.map(|angle| angle.value),
        misfit,
    })
}

fn misfit(section: &mut Section<'_>) -> Misfit {
    let word = section.word("interference", &["refuse", "cut-what-fits"]);
    match word {
        Some(word) if word.value == "cut-what-fits" => Misfit::CutWhatFits,
        _ => Misfit::Refuse,
    }
}
