//! What was measured on a path, whoever made it.

use serde::{Deserialize, Serialize};

use crate::axes::Axes;
use crate::coverage::{AxisCrossing, Coverage, Overrun};
use crate::errors::{ControlPointError, InterpolationError, PlayedCusp, Residual, Tolerances};
use crate::lead::LeadReport;
use crate::machine::{HighestSpindle, MachineReport, all_hold};
use crate::reach::Reach;
use crate::servo::ServoReport;
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
    /// What the real nose leaves where the path takes its radius as 0; `None` elsewhere.
    #[serde(default)]
    pub real_nose: Option<RealNose>,
    /// Motion of the axes over the cut.
    pub axes: Axes,
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
    /// The peak to valley that counts as the error of form, mm: that of the machined surface, or of
    /// the real nose where the path takes its radius as 0. `None` where nothing of the part is cut.
    pub fn form_error(&self) -> Option<f64> {
        let of_path = self.surface_error.as_ref().map(|error| error.pv);
        self.real_nose.as_ref().map(|nose| nose.pv).or(of_path)
    }

    /// Which tolerances and limits hold; `reach` is that of a file.
    pub fn verdict(&self, reach: Option<&Reach>) -> Verdict {
        let Tolerances {
            interpolation,
            residual,
        } = self.tolerance;
        let uncut = self.coverage.largest();
        let of_cut = self.machine.as_ref().map(|machine| &machine.limits[..]);
        let of_lead = self.lead.as_ref().map(|lead| &lead.limits[..]);
        let limits = [of_cut, of_lead].into_iter().flatten();
        Verdict {
            interpolation: within(self.interpolation_error.max, interpolation),
            residual: self.residual.max.is_some_and(|max| within(max, residual)),
            coverage: self.overrun.covers_part().then(|| within(uncut, residual)),
            machine: limits
                .filter_map(all_hold)
                .reduce(|one, other| one && other),
            lead: self
                .lead
                .as_ref()
                .map(|lead| within(-lead.smallest_clearance, interpolation)),
            reach: reach.map(Reach::covers_part),
            result: None,
            whole: None,
            programs: None,
        }
    }
}
