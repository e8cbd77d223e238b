//! What an ablation gave: the runs of its variants.

use serde::{Deserialize, Serialize};

use crate::format::FORMAT;
use crate::run::{ChainNames, RunReport};
use crate::sketch::ErrorSketch;
use crate::unit;
use crate::variations;
use crate::verdict::Verdict;

/// The runs of an ablation: the content of `ablation.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AblationReport {
    /// The form of the file, [`FORMAT`].
    pub format: u32,
    /// The runs, in the order of the variants.
    pub runs: Vec<AblationRun>,
}

/// One variant and what it gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AblationRun {
    /// What it gave.
    #[serde(flatten)]
    pub outcome: RunOutcome,
    /// Each key that varies, with this variant's value in words.
    #[serde(with = "variations")]
    pub varied: Vec<(String, String)>,
    /// Why it has no record, and is made each time; `None` where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_recorded: Option<String>,
}

/// What a variant gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum RunOutcome {
    /// The path was made and measured.
    Measured(Box<MeasuredRun>),
    /// There is no path.
    Failed(FailedRun),
}

/// A run of an ablation with its costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRun {
    /// As `turnpath run` writes it into `summary.json`, without programs.
    #[serde(flatten)]
    pub report: RunReport,
    /// Bytes of the lines that the recipe's first post makes of the points, or else `pmac-pvt`, header
    /// and footer aside; `None` where such a program cannot carry the path.
    pub program_bytes: Option<u64>,
    /// Processor time that one thread took to make the path, s, with all that refinement plays back;
    /// `None` where that was not measured.
    #[serde(rename = "planning_time_s", with = "unit::s")]
    pub planning_time: Option<f64>,
    /// Processor time that it took to measure the path, s; `None` in older files, whose time of
    /// planning has it too.
    #[serde(default, rename = "measuring_time_s", with = "unit::s")]
    pub measuring_time: Option<f64>,
    /// What pictures of its error need; `None` in older files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sketch: Option<ErrorSketch>,
}

/// A variant without a path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailedRun {
    /// The names of its strategies.
    pub chain: ChainNames,
    /// Why there is no path.
    pub error: String,
}

impl AblationReport {
    /// The runs of an ablation, with all numbers rounded to the digits of files.
    pub fn new(runs: Vec<AblationRun>) -> Self {
        crate::format::rounded_for_files(Self {
            format: FORMAT,
            runs,
        })
    }
}

impl From<RunReport> for MeasuredRun {
    /// A run whose costs were not measured.
    fn from(report: RunReport) -> Self {
        Self {
            report,
            program_bytes: None,
            planning_time: None,
            measuring_time: None,
            sketch: None,
        }
    }
}

impl AblationRun {
    /// A run with the keys that vary and their values in words.
    pub fn new(varied: Vec<(String, String)>, run: impl Into<MeasuredRun>) -> Self {
        Self {
            outcome: RunOutcome::Measured(Box::new(run.into())),
            varied,
            not_recorded: None,
        }
    }

    /// The run, where there is a path.
    pub fn measured(&self) -> Option<&MeasuredRun> {
        match &self.outcome {
            RunOutcome::Measured(run) => Some(run),
            RunOutcome::Failed(_) => None,
        }
    }

    /// Why there is no path.
    pub fn error(&self) -> Option<&str> {
        match &self.outcome {
            RunOutcome::Measured(_) => None,
            RunOutcome::Failed(failed) => Some(&failed.error),
        }
    }

    /// Which tolerances and limits hold, where there is a path.
    pub fn verdict(&self) -> Option<&Verdict> {
        self.measured().map(|run| run.report.verdict())
    }
}
