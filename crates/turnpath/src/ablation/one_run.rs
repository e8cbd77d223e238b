//! One run of an ablation, by its key: what a job of a queue makes.

use std::path::Path;

use rayon::ThreadPoolBuilder;
use turnpath_host::Catalogue;
use turnpath_recipe::Recipe;
use turnpath_report::AblationRun;
use turnpath_report::RunOutcome;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::plugins;

use super::observer::AblationObserver;
use super::record::{Records, RunRecord};
use super::variant::{self, Sources};
use super::{failed, refuse_unknown, row, variants};

/// Makes the run of a recipe's `[ablation]` that has this key, and leaves its record in `folder`. No
/// other run is looked at and nothing is locked, so any number of these may work at a time; of two on
/// one key the last record stays. A run that fails leaves a record with its reason, and so does one whose
/// process ends before it: it was begun.
///
/// # Errors
/// When there is no such run, when it fails, or when the record cannot be written.
pub fn run_of_ablation(
    recipe: &Recipe,
    catalogue: &Catalogue,
    folder: &Path,
    key: &str,
    observer: &dyn AblationObserver,
) -> Result<AblationRun, Error> {
    let data = DataFiles::default();
    let (variants, keys) = variants(recipe, catalogue, &data)?;
    refuse_unknown(&keys)?;
    let found = variants.iter().zip(&keys).find(|(_, of)| of.hash == key);
    let Some((variant, key)) = found else {
        let key = key.to_owned();
        return Err(Error::NoRunOfKey { key });
    };
    let records = Records::make(folder)?;
    if !matches!(records.read(key, observer), RunRecord::Measured(_)) {
        records.keep_begun(key, &failed(variant, lost(&variant.recipe, catalogue)))?;
    }
    let sources = Sources {
        catalogue,
        data: &data,
    };
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| Error::Threads(error.into()))?;
    match pool.install(|| variant::run(&variant.recipe, sources, observer)) {
        Ok(run) => {
            records.keep(None, key, &run)?;
            Ok(row(variant, RunOutcome::Measured(Box::new(run))))
        }
        Err(Error::Cancelled) => Err(Error::Cancelled),
        Err(error) => {
            records.keep(None, key, &failed(variant, error.title()))?;
            Err(error)
        }
    }
}

/// The reason in the record of a run that was begun: it stays where the process ends before the run does.
fn lost(recipe: &Recipe, catalogue: &Catalogue) -> String {
    let used = plugins::used(recipe, catalogue);
    let foreign = used
        .iter()
        .filter(|plugin| plugin.file.is_some() || plugin.source.is_some());
    let foreign: Vec<String> = foreign.map(|plugin| plugin.to_string()).collect();
    let by_plugin = match foreign.is_empty() {
        true => String::new(),
        false => format!(". A plugin may have ended it: {}", foreign.join(", ")),
    };
    format!(
        "it was begun and has not ended: its process is still at work, or was killed{by_plugin}"
    )
}
