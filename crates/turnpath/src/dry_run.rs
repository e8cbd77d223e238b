//! The dry runs of a recipe's programs: what a person should see at each stop.

use turnpath_core::{DEG, Scalar, StrategyError, SurfaceModel};
use turnpath_post::{DryStop, Extent};

use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::job::Job;
use crate::program::{Frame, Program};

/// Degrees of a turn.
const TURN_DEG: usize = 360;
/// Degrees from stop to stop.
const QUARTER_DEG: usize = 90;
/// Nanometres of a millimetre.
const NM: f64 = 1e6;
/// Differences below this cannot be seen by any eye or gauge, nm.
const SEEN_NM: f64 = 100.0;

/// The angle that tells most of the sense of C has a stop if it tells so many times more than a quarter of a turn.
const MUCH_MORE: f64 = 10.0;

impl Job {
    /// The dry run of a program whose path has this extent.
    pub(crate) fn dry_run(
        &self,
        program: &Program,
        frame: &Frame,
        extent: &Extent,
    ) -> Result<Vec<u8>, Error> {
        let rim = self.recipe.part.aperture_radius;
        let surface = &self.chain.surface;
        let heights = heights_at_rim(surface.strategy.as_ref(), rim);
        let heights = heights
            .map_err(|error| of_pipeline(&self.recipe, surface.failed("at the rim", error)))?;
        let stops = stops(&heights);
        let said = [
            format!("dry run of {}: it cuts nothing", program.file),
            format!(
                "the comments below, up to the first move, are those of {}",
                program.file
            ),
            format!(
                "Z stays {} mm or more above the highest place of the path, and the tool over the rim",
                program.layout.format.approach_height
            ),
            format!("it stops {} times; go on with cycle start", stops.len()),
            what_shows(&heights).to_owned(),
        ];
        let around = (frame.header.as_str(), frame.footer.as_str());
        let text = program.layout.dry_run(extent, rim, (&said, &stops), around);
        text.map_err(|source| Error::DryRun {
            file: program.dry_run_file(),
            source,
        })
    }
}

/// The surface at the rim at each whole degree of C, mm.
fn heights_at_rim(surface: &dyn SurfaceModel, rim: f64) -> Result<Vec<f64>, StrategyError> {
    let place = |deg: usize| match deg {
        0 => (rim, 0.0),
        90 => (0.0, rim),
        180 => (-rim, 0.0),
        270 => (0.0, -rim),
        _ => {
            let (sin, cos) = Scalar::sin_cos(deg as f64 * DEG);
            (rim * cos, rim * sin)
        }
    };
    let (x, y): (Vec<f64>, Vec<f64>) = (0..TURN_DEG).map(place).unzip();
    let mut z = vec![f64::NAN; TURN_DEG];
    surface.heights(&x, &y, &mut z)?;
    Ok(z)
}

/// What the heights show of the sense of C.
fn what_shows(heights: &[f64]) -> &'static str {
    let are_known = heights.iter().all(|height| height.is_finite());
    match telling_angle(heights) {
        Some(_) => {
            "if another place of the part is under the tool at a stop, change c_sign or the zero of C"
        }
        None if are_known => {
            "the heights are alike for both senses of C: a mark on the part shows the sense"
        }
        None => {
            "the part has no height at some angles of the rim: a mark on the part shows the sense of C"
        }
    }
}

/// The stops: four quarters of a turn, and the angle that tells most of the sense of C if the quarters tell
/// little.
fn stops(heights: &[f64]) -> Vec<DryStop> {
    let mut angles: Vec<usize> = (0..TURN_DEG).step_by(QUARTER_DEG).collect();
    let quarters_show = shows_sense(heights, QUARTER_DEG);
    let at_quarter = rise_over_opposite(heights, QUARTER_DEG).abs();
    let tells_more = |deg: &usize| {
        !quarters_show || rise_over_opposite(heights, *deg).abs() > MUCH_MORE * at_quarter
    };
    angles.extend(telling_angle(heights).filter(tells_more));
    angles.sort_unstable();
    let height = |deg: usize| heights.get(deg).copied().unwrap_or(f64::NAN);
    let stop = |deg: usize| DryStop {
        c_deg: deg as i64,
        said: format!(
            "C = {deg} deg of the path: {}",
            seen(height(deg) - height(0), deg)
        ),
    };
    angles.into_iter().map(stop).collect()
}

/// By how much the part is higher at an angle than at its opposite, where it would stand if C turned the other
/// way, mm.
fn rise_over_opposite(heights: &[f64], deg: usize) -> f64 {
    let height = |deg: usize| heights.get(deg).copied().unwrap_or(f64::NAN);
    height(deg) - height(TURN_DEG - deg)
}

/// Whether a person sees at an angle which way C turns.
fn shows_sense(heights: &[f64], deg: usize) -> bool {
    rise_over_opposite(heights, deg).abs() * NM >= SEEN_NM
}

/// The angle at which the part differs most from what lies there if C turns the other way; `None` if a person sees
/// no difference anywhere.
fn telling_angle(heights: &[f64]) -> Option<usize> {
    let telling = (1..TURN_DEG / 2).filter(|deg| shows_sense(heights, *deg));
    let difference = |deg: &usize| rise_over_opposite(heights, *deg).abs();
    // Of equal ones the first.
    telling
        .rev()
        .max_by(|one, other| difference(one).total_cmp(&difference(other)))
}

/// What a person sees of a height against that of the first stop, mm.
fn seen(higher: f64, c_deg: usize) -> String {
    let nm = higher * NM;
    match c_deg {
        0 => "the place with which the others are compared".to_owned(),
        _ if !nm.is_finite() => "the part has no height here".to_owned(),
        _ if nm.abs() < SEEN_NM => "the part is as high as at C = 0".to_owned(),
        _ => {
            let side = if nm > 0.0 { "higher" } else { "lower" };
            format!("the part is {:.1} um {side} than at C = 0", nm.abs() / 1e3)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rim whose height is that of a function of the angle, rad.
    fn rim(height: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..TURN_DEG).map(|deg| height(deg as f64 * DEG)).collect()
    }

    fn said(heights: &[f64]) -> Vec<String> {
        stops(heights).into_iter().map(|stop| stop.said).collect()
    }

    #[test]
    fn a_stop_says_how_much_higher_or_lower_the_part_is() {
        let mut heights = vec![0.1; TURN_DEG];
        (heights[90], heights[270]) = (0.1123, 0.0);
        let said = said(&heights);
        assert_eq!(said.len(), 4);
        assert_eq!(
            said[1],
            "C = 90 deg of the path: the part is 12.3 um higher than at C = 0"
        );
        assert!(said[2].ends_with("as high as at C = 0"));
        assert!(said[3].ends_with("100.0 um lower than at C = 0"));
        assert!(seen(f64::NAN, 90).contains("no height"));
    }

    #[test]
    fn a_fifth_stop_shows_the_sense_of_c_where_the_quarters_do_not() {
        let saddle = rim(|angle| 0.01 * Scalar::sin(2.0 * angle));
        let said = said(&saddle);
        assert_eq!(said.len(), 5);
        assert_eq!(
            said[1],
            "C = 45 deg of the path: the part is 10.0 um higher than at C = 0"
        );
        assert!(what_shows(&saddle).contains("change c_sign"));
    }

    #[test]
    fn a_rim_that_is_alike_for_both_senses_says_so() {
        let alike = rim(|angle| 0.01 * Scalar::cos(2.0 * angle));
        assert_eq!(stops(&alike).len(), 4);
        assert!(what_shows(&alike).contains("alike for both senses"));
        let unknown = rim(|angle| if angle > 3.2 { f64::NAN } else { 0.0 });
        assert!(what_shows(&unknown).contains("no height"));
    }

    #[test]
    fn a_quarter_that_tells_little_leaves_room_for_an_angle_that_tells_much() {
        let tilted = rim(|angle| 0.01 * Scalar::sin(2.0 * angle) + 1e-4 * Scalar::sin(angle));
        assert_eq!(stops(&tilted).len(), 5);
        let steep = rim(|angle| 0.01 * Scalar::sin(2.0 * angle) + 5e-3 * Scalar::sin(angle));
        assert_eq!(stops(&steep).len(), 4);
    }
}
