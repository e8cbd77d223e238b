//! What was measured on a path, whoever made it.

use serde::{Deserialize, Serialize};

use crate::axes::Axes;
use crate::coverage::{AxisCrossing, Coverage, Overrun};
use crate::cutting_speed::CuttingSpeed;
use crate::errors::{ControlPointError, InterpolationError, PlayedCusp, Residual, Tolerances};
use crate::form::FormReport;
use crate::lead::LeadReport;
use crate::machine::{HighestSpindle, MachineReport, all_hold};
use crate::reach::Reach;
use crate::servo::ServoReport;
use crate::spokes::{Arms, Spokes};
use crate::surface_error::{RealNose, SurfaceError};
use crate::unit;
use crate::verdict::{Verdict, within};

/// The figures of a path with what they are held to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathReport {
    /// The recipe's tolerances.
    pub tolerance: Tolerances,
    /// How far the path runs beyond the part.
    pub overrun: Overrun,
    /// Played − true tool centre.
    pub interpolation_error: InterpolationError,
    /// Control points − true tool centre, without the sampler's offsets where these are known.
    pub control_point_error: ControlPointError,
    /// The largest amount by which the sampler placed a control point off the locus, mm; `None` for a
    /// file, which does not say.
    #[serde(rename = "control_point_offset_nm", with = "unit::nm")]
    pub control_point_offset: Option<f64>,
    /// Cusps.
    pub residual: Residual,
    /// Cusps as played; `None` where no two passes meet on the part. No tolerance applies to it.
    #[serde(default)]
    pub played_cusp: Option<PlayedCusp>,
    /// What stays uncut.
    pub coverage: Coverage,
    /// How far the tool goes beyond the axis.
    pub axis_crossing: AxisCrossing,
    /// Machined − wanted surface; `None` where nothing of the part is cut.
    pub surface_error: Option<SurfaceError>,
    /// The largest spoke; `None` on a path of less than a turn, and in a report that was written
    /// before there was such a figure. No tolerance applies to it.
    #[serde(default)]
    pub spokes: Option<Spokes>,
    /// The largest spiral arms; `None` on a path of a few turns, and in a report that was written before
    /// there was such a figure. No tolerance applies to it.
    #[serde(default)]
    pub arms: Option<Arms>,
    /// What the real nose leaves where the path takes its radius as 0; `None` elsewhere.
    #[serde(default)]
    pub real_nose: Option<RealNose>,
    /// The machined surface against the tolerance of its form; `None` without such a tolerance.
    #[serde(default)]
    pub form: Option<FormReport>,
    /// Motion of the axes over the cut.
    pub axes: Axes,
    /// Cutting speed; `None` in a report that was written before there was such a figure.
    #[serde(default)]
    pub cutting_speed: Option<CuttingSpeed>,
    /// The machine's limits; `None` without any.
    pub machine: Option<MachineReport>,
    /// The highest speed of the spindle at which the cut holds all limits; `None` without a limit
    /// that was measured.
    pub highest_spindle: Option<HighestSpindle>,
    /// The leads; `None` without any.
    pub lead: Option<LeadReport>,
    /// What the servos make of the path; `None` where the recipe does not ask.
    pub servo: Option<ServoReport>,
}

impl PathReport {
    /// Which tolerances and limits hold; `reach` is that of a file.
    pub fn verdict(&self, reach: Option<&Reach>) -> Verdict {
        let tolerance = &self.tolerance;
        let uncut = self.coverage.largest();
        let is_within = |figure: Option<f64>, limit: f64| figure.is_some_and(|f| within(f, limit));
        let held = |figure: Option<f64>, limit: Option<f64>| limit.map(|l| is_within(figure, l));
        let of_cut = self.machine.as_ref().map(|machine| &machine.limits[..]);
        let of_lead = self.lead.as_ref().map(|lead| &lead.limits[..]);
        let limits = [of_cut, of_lead].into_iter().flatten();
        Verdict {
            interpolation: held(Some(self.interpolation_error.max), tolerance.interpolation),
            residual: held(self.residual.max, tolerance.residual),
            form: self
                .form
                .as_ref()
                .map(|form| is_within(form.pv, form.tolerance)),
            coverage: held(Some(uncut), tolerance.most_material())
                .filter(|_| self.overrun.covers_part()),
            machine: limits
                .filter_map(all_hold)
                .reduce(|one, other| one && other),
            servo: held(
                self.servo.map(|servo| servo.predicted_error.max),
                tolerance.servo,
            ),
            lead: self
                .lead
                .as_ref()
                .and_then(|lead| held(Some(-lead.smallest_clearance), tolerance.deepest())),
            reach: reach.map(Reach::covers_part),
            result: None,
            whole: None,
            spindle: None,
            programs: None,
            passes: None,
        }
    }
}
