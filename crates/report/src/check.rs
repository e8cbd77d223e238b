//! What a check gave: everything but the path.

use serde::{Deserialize, Serialize};

use crate::axis_notes::AxisNotes;
use crate::feed_cap::FeedCap;
use crate::form::FormReport;
use crate::format::FORMAT;
use crate::machine::MachineLimits;
use crate::part_shape::PartShape;
use crate::program::ControllerCommand;
use crate::remark::Remark;
use crate::tool_fit::ToolFit;
use crate::unit;
use crate::unreached::Unreached;

/// What a check gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckReport {
    /// The form of the JSON text, [`FORMAT`].
    pub format: u32,
    /// The job's name.
    pub name: String,
    /// The part's own shape; `None` in reports of earlier versions.
    #[serde(default)]
    pub part: Option<PartShape>,
    /// What the part asks of the tool.
    #[serde(flatten)]
    pub tool_fit: ToolFit,
    /// Limits that the path will be held to; `None` without any.
    pub machine: Option<MachineLimits>,
    /// What the nose leaves standing where it does not fit; `None` where the recipe refuses that.
    pub unreached: Option<Unreached>,
    /// The tolerance of form, with the tolerances that the first path is made for; `None` without
    /// such a tolerance.
    #[serde(default)]
    pub form: Option<FormReport>,
    /// What the path will be.
    pub expected: Estimate,
    /// What the paths before the finishing one will be, in their order.
    #[serde(default, rename = "passes", skip_serializing_if = "Vec::is_empty")]
    pub rough_paths: Vec<RoughPathEstimate>,
    /// Whether the reach of the nose sets the feed, and where.
    #[serde(default)]
    pub feed_cap: FeedCap,
    /// What the axes of the first program mean, or of a program with the default keys; `None` in reports of
    /// earlier versions.
    #[serde(default)]
    pub axis_notes: Option<AxisNotes>,
    /// What is allowed but seldom meant.
    #[serde(default)]
    pub remarks: Vec<Remark>,
    /// What the recipe's own header and footer put into the programs.
    #[serde(default)]
    pub controller_commands: Vec<ControllerCommand>,
}

/// What a path will be, refinement included. Revolutions, time and points are those without leads; the
/// sizes of files are those of the whole path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Revolutions of the cutting section.
    #[serde(with = "unit::one")]
    pub revolutions: f64,
    /// Time of the cutting section, s.
    #[serde(rename = "cutting_time_s", with = "unit::s")]
    pub cutting_time: f64,
    /// Control points of the cutting section, from a sample of it.
    pub control_points: u64,
    /// Bytes of `toolpath.csv`.
    pub toolpath_bytes: u64,
    /// The motion programs.
    pub programs: Vec<ProgramEstimate>,
}

/// What a path before the finishing one will be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoughPathEstimate {
    /// Its name in the recipe.
    pub name: String,
    /// What it should leave on the wanted surface along z, mm.
    #[serde(rename = "allowance_um", with = "unit::um")]
    pub allowance: f64,
    /// What it will be.
    pub expected: Estimate,
}

/// What a motion program will be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProgramEstimate {
    /// The file's name.
    pub file: String,
    /// Its size as text, with all of its parts.
    pub bytes: u64,
    /// Its blocks: lines of text.
    #[serde(default)]
    pub blocks: u64,
    /// The parts that it calls; `None` if it is one file.
    #[serde(default)]
    pub parts: Option<u64>,
    /// What its C means, as in [`AxisNotes::c`]; `None` in reports of earlier versions.
    #[serde(default)]
    pub c_means: Option<String>,
}

impl CheckReport {
    /// The report with all numbers rounded to the digits of files.
    #[must_use]
    pub fn rounded(mut self) -> Self {
        self.format = FORMAT;
        crate::format::rounded_for_files(self)
    }
}
