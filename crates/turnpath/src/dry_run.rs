//! The dry runs of a recipe's programs: what a person should see at each stop.

use turnpath_core::{StrategyError, SurfaceModel};
use turnpath_post::{DryStop, Extent};

use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::job::Job;
use crate::program::{Frame, Program};

/// Degrees from stop to stop.
const QUARTER_DEG: i64 = 90;
/// Nanometres of a millimetre.
const NM: f64 = 1e6;
/// Differences below this cannot be seen by any eye or gauge, nm.
const SEEN_NM: f64 = 100.0;

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
        let stops = stops(heights);
        let said = [
            format!("dry run of {}: it cuts nothing", program.file),
            format!(
                "Z stays {} mm or more above the highest place of the path, and the tool over the rim",
                program.layout.format.approach_height
            ),
            "it stops four times; go on with cycle start".to_owned(),
            "if the part under the tool is not as said at a stop, change c_sign".to_owned(),
        ];
        let around = (frame.header.as_str(), frame.footer.as_str());
        let text = program.layout.dry_run(extent, rim, (&said, &stops), around);
        text.map_err(|source| Error::DryRun {
            file: program.dry_run_file(),
            source,
        })
    }
}

/// The surface at the rim, where C is 0, 90, 180 and 270 deg, mm.
fn heights_at_rim(surface: &dyn SurfaceModel, rim: f64) -> Result<[f64; 4], StrategyError> {
    let mut z = [f64::NAN; 4];
    surface.heights(&[rim, 0.0, -rim, 0.0], &[0.0, rim, 0.0, -rim], &mut z)?;
    Ok(z)
}

fn stops(heights: [f64; 4]) -> Vec<DryStop> {
    let quarters = (0..).step_by(QUARTER_DEG as usize);
    let stop = |(c_deg, height): (i64, f64)| DryStop {
        c_deg,
        said: format!(
            "C = {c_deg} deg of the path: {}",
            seen(height - heights[0], c_deg)
        ),
    };
    quarters.zip(heights).map(stop).collect()
}

/// What a person sees of a height against that of the first stop, mm.
fn seen(higher: f64, c_deg: i64) -> String {
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

    #[test]
    fn a_stop_says_how_much_higher_or_lower_the_part_is() {
        let said: Vec<String> = stops([0.1, 0.1123, 0.1, 0.0])
            .into_iter()
            .map(|stop| stop.said)
            .collect();
        assert_eq!(
            said[1],
            "C = 90 deg of the path: the part is 12.3 um higher than at C = 0"
        );
        assert!(said[2].ends_with("as high as at C = 0"));
        assert!(said[3].ends_with("100.0 um lower than at C = 0"));
        assert!(seen(f64::NAN, 90).contains("no height"));
    }
}
