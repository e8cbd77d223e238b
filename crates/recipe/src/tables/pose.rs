//! `[part.pose]`: where the part lies on the surface, and how the surface is turned.

use turnpath_core::kind::{Angle, Flag, Length};
use turnpath_core::{Attitude, DEG, Param, Pose};

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::table_info::TableInfo;

/// The largest tilt, rad: beyond it no tool reaches the surface.
const LARGEST_TILT: f64 = 80.0 * DEG;

const X: Param<Length> =
    Param::length("x", "the part's middle on the surface, along x").default(0.0);
const Y: Param<Length> =
    Param::length("y", "the part's middle on the surface, along y").default(0.0);
const LEVEL: Param<Flag> = Param::flag(
    "level",
    "whether the normal at the part's middle is turned onto the spindle axis, by the shortest \
     rotation",
)
.default(false);
const TILT_X: Param<Angle> = Param::angle(
    "tilt_x",
    "turn about the machine's x, before `tilt_y`; positive: the side of positive y rises",
)
.min(-LARGEST_TILT)
.max(LARGEST_TILT)
.default(0.0);
const TILT_Y: Param<Angle> = Param::angle(
    "tilt_y",
    "turn about the machine's y; positive: the side of positive x sinks",
)
.min(-LARGEST_TILT)
.max(LARGEST_TILT)
.default(0.0);

pub(super) const POSE: TableInfo = TableInfo {
    name: "part.pose",
    summary: "where the part lies on the surface; the part's middle comes to the origin",
    required: false,
    keys: &[
        X.info(),
        Y.info(),
        LEVEL.info(),
        TILT_X.info(),
        TILT_Y.info(),
    ],
};

/// Reads `[part.pose]`; the inner `None` stands for a recipe without it.
pub(crate) fn pose(section: &mut Section<'_>) -> Option<Option<Pose>> {
    section.report_unless_table();
    if section.is_something_else() {
        return None;
    }
    if section.table.is_none() {
        return Some(None);
    }
    let params = section.bind(&POSE);
    let level = params.find(LEVEL)?;
    if level {
        refuse_tilts(section)?;
    }
    let attitude = match level {
        true => Attitude::Level,
        false => Attitude::Tilted {
            tilt_x: params.find(TILT_X)?,
            tilt_y: params.find(TILT_Y)?,
        },
    };
    Some(Some(Pose {
        x: params.find(X)?,
        y: params.find(Y)?,
        attitude,
    }))
}

/// A level part has no tilt of its own.
fn refuse_tilts(section: &mut Section<'_>) -> Option<()> {
    let mut tilts = [TILT_X, TILT_Y].into_iter().map(Param::name);
    let Some(tilt) = tilts.find(|tilt| section.node(tilt).is_some()) else {
        return Some(());
    };
    let title = format!("`{tilt}` and `level = true` contradict each other");
    let diagnostic = Diagnostic::new(section.nearest_span(tilt), title)
        .with_label("a level part has no tilt")
        .with_help(format!("leave out `{tilt}`, or `level`"));
    section.report(diagnostic);
    None
}
