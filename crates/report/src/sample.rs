//! A real report, for tests.

use crate::ablation::{AblationRun, FailedRun, MeasuredRun, RunOutcome};
use crate::format::from_json;
use crate::run::RunReport;

/// `summary.json` of docs/recipes/astigmatic-5mm.toml on a machine with limits and with servos.
pub const SUMMARY: &str = include_str!("../tests/data/summary.json");

/// The same as a report.
pub fn run_report() -> RunReport {
    from_json(SUMMARY).unwrap()
}

/// A measured run of an ablation, as `change` leaves it.
pub fn measured_run(
    varied: Vec<(String, String)>,
    change: impl FnOnce(&mut MeasuredRun),
) -> AblationRun {
    let mut run = MeasuredRun {
        report: run_report(),
        program_bytes: None,
        planning_time: 1.0,
    };
    change(&mut run);
    AblationRun {
        outcome: RunOutcome::Measured(Box::new(run)),
        varied,
    }
}

/// A failed run of an ablation.
pub fn failed_run(varied: Vec<(String, String)>, reason: &str) -> AblationRun {
    AblationRun {
        outcome: RunOutcome::Failed(FailedRun {
            chain: run_report().chain,
            error: reason.to_owned(),
        }),
        varied,
    }
}
