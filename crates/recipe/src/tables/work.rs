//! `[part]` and `[tool]`: the part and the tool that cuts it.

use std::f64::consts::PI;

use turnpath_core::kind::{Angle, Choice, Length};
use turnpath_core::{Misfit, Param, Part, Quantity, Tool};

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::table_info::TableInfo;

/// The smallest length of a part or a tool that can be made, 0.1 um in mm.
const LEAST_LENGTH: f64 = 1e-4;
/// The largest nose, 1 m in mm. A tool that turns a part has a far smaller one, and beside a nose of
/// a kilometre the part has too few digits left.
const LARGEST_NOSE: f64 = 1000.0;

const APERTURE: Param<Length> = Param::length("aperture", "diameter of the part")
    .min(LEAST_LENGTH)
    .example("5 mm");
const INNER: Param<Length> = Param::length("inner", "diameter of the hole, below `aperture`")
    .min(0.0)
    .default(0.0);

const NOSE_RADIUS: Param<Length> = Param::length("nose_radius", "radius of the nose")
    .min(LEAST_LENGTH)
    .max(LARGEST_NOSE)
    .example("1 mm");
const INCLUDED_ANGLE: Param<Option<Angle>> = Param::angle(
    "included_angle",
    "angle that the round edge spans: the contact can be up to half of it to either side; left out: \
     180 deg, not checked",
)
.positive()
.max(PI)
.example("90 deg")
.optional();
const CLEARANCE_ANGLE: Param<Option<Angle>> = Param::angle(
    "clearance_angle",
    "angle below the rake face: the steepest slope along the cut that the tool clears; left out: not \
     checked",
)
.positive()
.below(0.5 * PI)
.example("10 deg")
.optional();
const INTERFERENCE: Param<Choice> = Param::choice(
    "interference",
    &["refuse", CUT_WHAT_FITS],
    "what to do where nose or edge do not fit; refuse: exit status 2; cut-what-fits: go where \
     the edge first touches, and report what stays",
)
.default("refuse");
const CUT_WHAT_FITS: &str = "cut-what-fits";

pub(super) const PART: TableInfo = TableInfo {
    name: "part",
    summary: "a disc around the spindle axis, with or without a hole",
    required: true,
    keys: &[APERTURE.info(), INNER.info()],
};

pub(super) const TOOL: TableInfo = TableInfo {
    name: "tool",
    summary: "a round nose with zero rake",
    required: true,
    keys: &[
        NOSE_RADIUS.info(),
        INCLUDED_ANGLE.info(),
        CLEARANCE_ANGLE.info(),
        INTERFERENCE.info(),
    ],
};

/// Reads `[part]`.
pub(crate) fn part(section: &mut Section<'_>) -> Option<Part> {
    if !section.is_there(&PART) {
        return None;
    }
    let params = section.bind(&PART);
    let (aperture, hole) = (params.find(APERTURE)?, params.find(INNER)?);
    if hole >= aperture {
        let span = section.nearest_span(INNER.name());
        let whole = Quantity::Length.format(aperture);
        let diagnostic = Diagnostic::new(span, "the hole is not smaller than the aperture")
            .with_label(format!("must be below {whole}"))
            .with_help("`inner` is the diameter of the hole, `aperture` that of the part");
        section.report(diagnostic);
        return None;
    }
    Some(Part {
        aperture_radius: 0.5 * aperture,
        inner_radius: 0.5 * hole,
    })
}

/// Reads `[tool]`.
pub(crate) fn tool(section: &mut Section<'_>) -> Option<Tool> {
    if !section.is_there(&TOOL) {
        return None;
    }
    let params = section.bind(&TOOL);
    Some(Tool {
        nose_radius: params.find(NOSE_RADIUS)?,
        included_angle: params.find(INCLUDED_ANGLE)?,
        clearance_angle: params.find(CLEARANCE_ANGLE)?,
        misfit: match params.find(INTERFERENCE)? {
            CUT_WHAT_FITS => Misfit::CutWhatFits,
            _ => Misfit::Refuse,
        },
    })
}
