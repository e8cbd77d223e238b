//! What a run gave.

use serde::{Deserialize, Serialize};

use crate::axes::Axes;
use crate::feed_cap::FeedCap;
use crate::format::FORMAT;
use crate::path::PathReport;
use crate::program::{ControllerCommand, ProgramReport};
use crate::remark::Remark;
use crate::rough_path::RoughPathReport;
use crate::unit;
use crate::unreached::Unreached;
use crate::verdict::Verdict;

/// What a run gave: the content of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// The form of the file, [`FORMAT`].
    pub format: u32,
    /// The version of turnpath that made it.
    pub turnpath: String,
    /// The job's name.
    pub name: String,
    /// The strategies.
    pub chain: ChainNames,
    /// Which way the tool feeds.
    pub direction: Direction,
    /// Whether segments whose error exceeds the tolerance were halved.
    pub refine: bool,
    /// Control points of the cutting section.
    pub control_points: u64,
    /// Control points of all sections.
    pub rows: u64,
    /// Control points that refinement added.
    pub points_added_by_refine: u64,
    /// Revolutions of the cutting section.
    #[serde(with = "unit::one")]
    pub revolutions: f64,
    /// Time of the cutting section, s.
    #[serde(rename = "cutting_time_s", with = "unit::s")]
    pub cutting_time: f64,
    /// Whether the reach of the nose sets the feed, and where.
    #[serde(default)]
    pub feed_cap: FeedCap,
    /// What was measured on the path.
    #[serde(flatten)]
    pub path: PathReport,
    /// The axes where the law is the feed strategy's own; `None` where another took its place.
    pub axes_of_law: Option<Axes>,
    /// What the nose leaves standing where it does not fit; `None` where the recipe refuses that.
    pub unreached: Option<Unreached>,
    /// The motion programs.
    pub programs: Vec<ProgramReport>,
    /// The paths before the finishing one, in their order.
    #[serde(default, rename = "passes", skip_serializing_if = "Vec::is_empty")]
    pub rough_paths: Vec<RoughPathReport>,
    /// What the recipe's own header and footer put into the programs.
    #[serde(default)]
    pub controller_commands: Vec<ControllerCommand>,
    /// The plugins that the strategies come from.
    pub plugins: Vec<PluginSource>,
    /// The data files that the recipe's strategies read.
    #[serde(default)]
    pub data_files: Vec<DataSource>,
    /// What was run; `None` in an ablation, where the key of a run says it, and in older files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recipe: Option<RecipeSource>,
    /// The other files of the result that this summary is beside; `None` where the run wrote no
    /// files, and in older files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub files: Option<Vec<ResultFile>>,
    /// What is allowed but seldom meant.
    #[serde(default)]
    pub remarks: Vec<Remark>,
    /// Which tolerances and limits hold, on the path and on each program.
    pub within: Verdict,
}

/// Which way the tool feeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// From the rim to the centre.
    Inward,
    /// From the centre to the rim.
    Outward,
}

/// The names of the strategies.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChainNames {
    /// The surface model.
    pub surface: String,
    /// The feed strategy.
    pub feed: String,
    /// The sampler.
    pub sampler: String,
    /// The compensator.
    pub compensator: String,
    /// The velocity solver.
    pub velocity: String,
    /// The spindle strategy.
    pub spindle: String,
}

/// A plugin that a strategy comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PluginSource {
    /// The package's name.
    pub name: String,
    /// The package's version.
    pub version: String,
    /// The library's path, or where the source of the program's own strategies is; `None` for one
    /// that is built in.
    pub file: Option<String>,
    /// SHA-256 of the library, or of that source.
    pub sha256: Option<String>,
}

/// A data file that a strategy reads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DataSource {
    /// The slot of the strategy.
    pub slot: String,
    /// The parameter that names the file.
    pub param: String,
    /// The path as the recipe gives it.
    pub file: String,
    /// The number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: String,
}

/// The recipe of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecipeSource {
    /// The name of its file.
    pub file: String,
    /// SHA-256 of its text, without the changes.
    pub sha256: String,
    /// The changes by `--set`, `key=value`, in their order.
    pub sets: Vec<String>,
    /// Its text, without the changes; `None` in older files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
}

/// A file of a result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultFile {
    /// Its name in the folder of the summary.
    pub file: String,
    /// The number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: String,
}

impl RunReport {
    /// Judges the path and its programs, and rounds all numbers to the digits of files, so that
    /// the report equals the one that is read back.
    #[must_use]
    pub fn with_verdict(mut self) -> Self {
        self.format = FORMAT;
        self.within = self.path.verdict(None);
        if !self.programs.is_empty() {
            let holds = self.programs.iter().all(ProgramReport::holds);
            self.within.programs = Some(holds);
        }
        if !self.rough_paths.is_empty() {
            let holds = self.rough_paths.iter().all(|rough| rough.within.holds());
            self.within.passes = Some(holds);
        }
        crate::format::rounded_for_files(self)
    }

    /// Which tolerances and limits hold.
    pub fn verdict(&self) -> &Verdict {
        &self.within
    }
}
