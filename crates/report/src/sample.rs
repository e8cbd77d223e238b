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
    let mut run = MeasuredRun::from(run_report());
    change(&mut run);
    AblationRun::new(varied, run)
}

/// A failed run of an ablation.
pub fn failed_run(varied: Vec<(String, String)>, reason: &str) -> AblationRun {
    AblationRun {
        outcome: RunOutcome::Failed(FailedRun {
            chain: run_report().chain,
            error: reason.to_owned(),
        }),
        varied,
        not_recorded: None,
    }
}
