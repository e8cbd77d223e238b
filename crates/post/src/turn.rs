//! The check of C from one control point to the next, for the readers of all files.

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};

/// Most degrees that C may turn between two points of the cutting section: with more, points are
/// missing.
const LARGEST_TURN_DEG: f64 = 360.0;
/// A turn that is surely no more than that, rad: nearly all turns are below it, and need no division.
const SMALL_TURN: f64 = 6.0;
/// Largest C: half a year at 10⁴ rpm. A double still holds it to a ten-thousandth of a degree.
/// With a far larger C, a double could no longer distinguish parts of a turn.
const LARGEST_C_DEG: f64 = 1e12;

/// Checks C. It must be an angle that a double can distinguish from neighbouring angles. In the
/// cutting section it must grow, and by no more than it can if no point is missing.
pub(crate) fn check_turn(
    last: Option<&(ControlPoint, Section)>,
    point: &ControlPoint,
    section: Section,
) -> Result<(), String> {
    let turn = last.map(|(last, _)| point.c - last.c);
    let is_small = |turn: &f64| 0.0 < *turn && *turn < SMALL_TURN;
    let turn = turn.filter(|turn| section == Section::Cutting && !is_small(turn));
    let grows = |turn: f64| turn > 0.0 && turn <= LARGEST_TURN_DEG;
    if let Some(turn) = turn.map(|turn| turn / DEG).filter(|turn| !grows(*turn)) {
        return Err(format!(
            "C turns by {turn:?} deg from the previous point; it must grow, by at most 360 deg"
        ));
    }
    // No division where C is far below.
    if point.c.abs() > LARGEST_C_DEG * (0.5 * DEG) && point.c.abs() / DEG > LARGEST_C_DEG {
        let c = point.c / DEG;
        return Err(format!(
            "C = {c:e} deg is more than {LARGEST_C_DEG:e} deg, the largest that a path may have"
        ));
    }
    Ok(())
}
