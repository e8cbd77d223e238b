//! The table of an ablation from its records, with nothing made.

use std::path::Path;

use turnpath_host::Catalogue;
use turnpath_recipe::Recipe;
use turnpath_report::{AblationReport, RunOutcome};

use crate::data_files::DataFiles;
use crate::error::Error;

use super::files::AblationFiles;
use super::observer::AblationObserver;
use super::record::{Records, RunRecord};
use super::{AblationResult, failed, refuse_unknown, row, variants};

/// What stands in the row of a run without a record.
const MISSING: &str = "not made yet";

/// Writes the files of an ablation from the records in `folder`. A run without a record is a row that
/// says so, and one that failed has its reason; both count in [`AblationResult::without_figures`].
///
/// # Errors
/// As those of [`ablate`](crate::ablate), but for those of the work.
pub fn merge_ablation(
    recipe: &Recipe,
    catalogue: &Catalogue,
    folder: &Path,
    observer: &dyn AblationObserver,
) -> Result<AblationResult, Error> {
    let data = DataFiles::default();
    let (variants, keys) = variants(recipe, catalogue, &data)?;
    refuse_unknown(&keys)?;
    let files = AblationFiles::new(folder)?;
    let records = Records::of(folder);
    let mut without_figures = 0;
    let mut runs = Vec::new();
    for (variant, key) in variants.iter().zip(&keys) {
        let outcome = match records.read(key, observer) {
            RunRecord::Measured(run) => RunOutcome::Measured(run),
            RunRecord::Failed(failed) | RunRecord::Begun(failed) => RunOutcome::Failed(failed),
            RunRecord::None => RunOutcome::Failed(failed(variant, MISSING.to_owned())),
        };
        without_figures += usize::from(matches!(outcome, RunOutcome::Failed(_)));
        runs.push(row(variant, outcome));
    }
    let report = AblationReport::new(runs);
    Ok(AblationResult {
        files: files.write(&report)?,
        reused: report.runs.len() - without_figures,
        report,
        failures: Vec::new(),
        without_figures,
    })
}
