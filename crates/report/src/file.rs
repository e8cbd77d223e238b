//! What a file of a tool path gave.

use serde::{Deserialize, Serialize};

use crate::anomalies::Anomalies;
use crate::format::FORMAT;
use crate::path::PathReport;
use crate::program::ControllerCommand;
use crate::reach::Reach;
use crate::result_check::ResultCheck;
use crate::unit;
use crate::unreached::Unreached;
use crate::verdict::Verdict;
use crate::wholeness::Wholeness;

/// Part of the spindle's speed that the RMS of C's speed may reach: a little is rounding.
const RMS_ALLOWANCE: f64 = 1.01;
/// Part of the spindle's speed that C may reach anywhere. A short segment of a program is faster than the spindle by
/// what the digits of C and the steps of time round.
const SEGMENT_ALLOWANCE: f64 = 2.0;

/// What `verify` measured on a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileReport {
    /// The form of the JSON text, [`FORMAT`].
    pub format: u32,
    /// The job's name.
    pub name: String,
    /// The file.
    pub file: String,
    /// The surface model that it was measured against.
    pub surface: String,
    /// Control points of the cutting section.
    pub control_points: u64,
    /// Control points of all sections.
    pub rows: u64,
    /// From which to which radius the path runs.
    pub reach: Reach,
    /// Whether the path is there from its beginning to its end, by the file itself; `None` if a file
    /// of this recipe does not show it, since the path has no leads.
    #[serde(default)]
    pub wholeness: Option<Wholeness>,
    /// The largest speed of the recipe's spindle, rad/s; `None` in a report that was written before it was judged.
    #[serde(
        default,
        rename = "spindle_limit_rpm",
        with = "unit::rpm",
        skip_serializing_if = "Option::is_none"
    )]
    pub spindle_limit: Option<f64>,
    /// What was measured on the path.
    #[serde(flatten)]
    pub path: PathReport,
    /// Maps, profiles, circles and spectra that were written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// Rows that are not as the recipe gives them, or stand out among their neighbours.
    pub anomalies: Anomalies,
    /// What the nose leaves standing where it does not fit; `None` where it leaves nothing.
    pub unreached: Option<Unreached>,
    /// What the summary beside the file says of it; `None` where there is none, or it does not list
    /// the file.
    #[serde(default)]
    pub result: Option<ResultCheck>,
    /// What the header and the footer of a program tell the controller, where the recipe's templates do not
    /// and it is not known to be harmless. Lines are those of the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub controller_commands: Vec<ControllerCommand>,
    /// Commands of the recipe's header and footer that a program lacks. Lines are those of the templates.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing_commands: Vec<ControllerCommand>,
    /// Which tolerances and limits hold.
    pub within: Verdict,
}

impl FileReport {
    /// Judges the path, and rounds all numbers to the digits of files.
    #[must_use]
    pub fn with_verdict(mut self) -> Self {
        self.format = FORMAT;
        self.within = Verdict {
            whole: self.wholeness.as_ref().map(Wholeness::is_whole),
            result: self.result.as_ref().map(|result| result.holds),
            spindle: self.keeps_spindle_speed(),
            ..self.path.verdict(Some(&self.reach))
        };
        crate::format::rounded_for_files(self)
    }

    /// Whether C turns no faster in the cut than the recipe's spindle; `None` where nothing says how fast that is.
    fn keeps_spindle_speed(&self) -> Option<bool> {
        let limit = self.spindle_limit?;
        let speed = &self.path.axes.c.velocity;
        Some(speed.rms <= RMS_ALLOWANCE * limit && speed.max <= SEGMENT_ALLOWANCE * limit)
    }

    /// Which tolerances and limits hold.
    pub fn verdict(&self) -> &Verdict {
        &self.within
    }
}
