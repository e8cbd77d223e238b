//! The check of C from one control point to the next, and of velocities, for the readers of all files.

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};

/// Most degrees that C may turn between two points: with more, points are missing.
const LARGEST_TURN_DEG: f64 = 360.0;
/// A turn that is surely no more than that, rad: nearly all turns are below it, and need no division.
const SMALL_TURN: f64 = 6.0;
/// Largest C: half a year at 10⁴ rpm. A double still holds it to a ten-thousandth of a degree.
/// With a far larger C, a double could no longer distinguish parts of a turn.
const LARGEST_C_DEG: f64 = 1e12;

/// Refuses a velocity that no machine has.
pub(crate) fn check_velocities(point: &ControlPoint) -> Result<(), String> {
    point.wild_velocity().map_or(Ok(()), Err)
}

/// Checks C. It must be an angle that a double can distinguish from neighbouring angles. It must grow, and by
/// no more than it can if no point is missing. Only in a lead, near rest, may it stand still.
pub(crate) fn check_turn(
    last: Option<&(ControlPoint, Section)>,
    point: &ControlPoint,
    section: Section,
) -> Result<(), String> {
    let turn = last.map(|(last, _)| point.c - last.c);
    let is_small = |turn: &f64| 0.0 < *turn && *turn < SMALL_TURN;
    let may_stand = section != Section::Cutting;
    let grows = |turn: f64| (turn > 0.0 || may_stand && turn == 0.0) && turn <= LARGEST_TURN_DEG;
    let turn = turn.filter(|turn| !is_small(turn)).map(|turn| turn / DEG);
    if let Some(turn) = turn.filter(|turn| !grows(*turn)) {
        let must = match may_stand {
            true => "it must not turn back, and grow by at most 360 deg",
            false => "it must grow, by at most 360 deg",
        };
        return Err(format!(
            "C turns by {turn:?} deg from the previous point; {must}"
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether C may turn so far from one point of a section to the next.
    fn may_turn(deg: f64, section: Section) -> bool {
        let at = |c: f64| ControlPoint {
            c: c * DEG,
            ..ControlPoint::default()
        };
        let last = (at(1000.0), section);
        check_turn(Some(&last), &at(1000.0 + deg), section).is_ok()
    }

    #[test]
    fn velocities_beyond_any_machine_are_refused() {
        let at = |vz: f64| ControlPoint {
            vz,
            ..ControlPoint::default()
        };
        assert_eq!(check_velocities(&at(-1e11)), Ok(()));
        for vz in [1e13, -1e32, f64::INFINITY, f64::NAN] {
            assert!(check_velocities(&at(vz)).is_err(), "{vz}");
        }
    }

    #[test]
    fn c_grows_by_a_turn_at_most_in_the_cut_and_in_leads() {
        for section in [Section::LeadIn, Section::Cutting, Section::LeadOut] {
            for deg in [1e-7, 5.0, 359.9] {
                assert!(may_turn(deg, section), "{section:?}: {deg}");
            }
            for deg in [-1e7, -5.0, 360.1, 5.6e9] {
                assert!(!may_turn(deg, section), "{section:?}: {deg}");
            }
        }
        // Near rest a lead's C may keep its last digit.
        let may_stand = |section| may_turn(0.0, section);
        assert!(may_stand(Section::LeadIn) && may_stand(Section::LeadOut));
        assert!(!may_stand(Section::Cutting));
    }
}
