//! An ablation: the variants of a recipe made, measured and set side by side.
//!
//! Every run leaves a record in `DIR/runs`, named by the hash of all that the run depends on. A run
//! whose record is there is not made again, so an interrupted ablation goes on where it stopped.

mod clock;
mod files;
mod key;
mod merge;
mod observer;
mod one_run;
mod pack;
mod pack_error;
mod plan;
mod record;
mod runs;
mod variant;

use std::num::NonZero;
use std::path::PathBuf;

use turnpath_host::Catalogue;
use turnpath_recipe::{Diagnostic, Diagnostics, Recipe, Variant};
use turnpath_report::{AblationReport, AblationRun, FailedRun, MeasuredRun, RunOutcome};

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::run::chain_names;
use crate::strategies::{choices, wrong_choices};

use files::AblationFiles;
pub use key::FIGURES;
use key::{Key, Keys};
pub use merge::merge_ablation;
pub use observer::AblationObserver;
pub use one_run::run_of_ablation;
pub use pack::{PackedAblation, pack_ablation};
pub use pack_error::PackError;
pub use plan::{AblationPlan, RunPlan, RunState, plan_ablation};
use record::{Records, RunRecord};
use runs::Outcome;
use variant::Sources;

/// How an ablation is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AblationOptions {
    /// Where its files and the records of its runs go; made if it is not there.
    pub folder: PathBuf,
    /// Whether all runs are made anew, also those that have a record.
    pub fresh: bool,
    /// How many runs are made at a time; as many as there are cores unless given.
    pub threads: Option<NonZero<usize>>,
}

/// What an ablation gave.
#[derive(Debug)]
pub struct AblationResult {
    /// The runs side by side.
    pub report: AblationReport,
    /// The files that were written.
    pub files: Vec<PathBuf>,
    /// How many runs were taken from their records.
    pub reused: usize,
    /// Why runs failed, with their places in the report.
    pub failures: Vec<(usize, Error)>,
    /// How many runs have no figures because nothing was made: those without a record, and those that
    /// failed or were begun.
    pub without_figures: usize,
}

/// Makes the variants that a recipe's `[ablation]` lists and writes their figures. Tolerances that
/// do not hold are what an ablation shows: they are no failure.
///
/// # Errors
/// When the recipe has no `[ablation]`, when a variant chooses wrongly, when a data file cannot be
/// read, or when a file cannot be written. A run that fails is a row of the report.
pub fn ablate(
    recipe: &Recipe,
    catalogue: &Catalogue,
    options: &AblationOptions,
    observer: &dyn AblationObserver,
) -> Result<AblationResult, Error> {
    let data = DataFiles::default();
    let (variants, keys) = variants(recipe, catalogue, &data)?;
    let files = AblationFiles::new(&options.folder)?;
    let records = Records::make(files.folder().path())?;
    let recorded = recorded(options, &records, &keys, observer);
    let reused = recorded.iter().flatten().count();
    let outcomes = runs::complete(
        &variants,
        Sources {
            catalogue,
            data: &data,
        },
        recorded,
        options.threads,
        observer,
        |index, outcome| {
            let place = keys.get(index).zip(variants.get(index));
            let (key, variant) = place.ok_or(Error::RunLost)?;
            let folder = Some(files.folder());
            match outcome {
                _ if key.unknown.is_some() => Ok(()),
                Ok(run) => records.keep(folder, key, run),
                Err(error) => records.keep(folder, key, &failed(variant, error.title())),
            }
        },
    )?;
    let (runs, failures) = rows(&variants, &keys, outcomes);
    let report = AblationReport::new(runs);
    Ok(AblationResult {
        files: files.write(&report)?,
        report,
        reused,
        failures,
        without_figures: 0,
    })
}

/// The variants of a recipe with their keys.
fn variants(
    recipe: &Recipe,
    catalogue: &Catalogue,
    data: &DataFiles,
) -> Result<(Vec<Variant>, Vec<Key>), Error> {
    let variants = recipe.variants()?;
    refuse_wrong_choices(&variants, catalogue)?;
    let keys = Keys::new(catalogue, data).of_all(&variants)?;
    Ok((variants, keys))
}

/// A queue knows a run by its key alone, so each run needs one.
fn refuse_unknown(keys: &[Key]) -> Result<(), Error> {
    let unknown = keys.iter().find_map(|key| key.unknown.clone());
    unknown.map_or(Ok(()), |why| Err(Error::NoKey { why }))
}

/// Strategies that are not there, or do not take the parameters that the lists give them, are
/// refused before the work.
fn refuse_wrong_choices(variants: &[Variant], catalogue: &Catalogue) -> Result<(), Error> {
    let mut all: Vec<Diagnostic> = Vec::new();
    for variant in variants {
        for diagnostic in wrong_choices(choices(&variant.recipe), catalogue) {
            if !all.contains(&diagnostic) {
                all.push(diagnostic);
            }
        }
    }
    match all.is_empty() {
        true => Ok(()),
        false => Err(Error::refused(all.into_iter().collect::<Diagnostics>())),
    }
}

/// The runs that have a record.
fn recorded(
    options: &AblationOptions,
    records: &Records,
    keys: &[Key],
    observer: &dyn AblationObserver,
) -> Vec<Option<MeasuredRun>> {
    let one = |key: &Key| match options.fresh || key.unknown.is_some() {
        true => None,
        false => match records.read(key, observer) {
            RunRecord::Measured(run) => Some(*run),
            RunRecord::Failed(_) | RunRecord::Begun(_) | RunRecord::None => None,
        },
    };
    keys.iter().map(one).collect()
}

/// The rows of the report, and why runs failed.
fn rows(
    variants: &[Variant],
    keys: &[Key],
    outcomes: Vec<Outcome>,
) -> (Vec<AblationRun>, Vec<(usize, Error)>) {
    let (mut runs, mut failures) = (Vec::new(), Vec::new());
    let known = variants.iter().zip(keys);
    for (index, ((variant, key), outcome)) in known.zip(outcomes).enumerate() {
        let outcome = match outcome {
            Ok(run) => RunOutcome::Measured(Box::new(run)),
            Err(error) => {
                let row = failed(variant, error.title());
                failures.push((index, error));
                RunOutcome::Failed(row)
            }
        };
        runs.push(AblationRun {
            not_recorded: key.unknown.clone(),
            ..row(variant, outcome)
        });
    }
    (runs, failures)
}

/// A variant that gave no path.
fn failed(variant: &Variant, error: String) -> FailedRun {
    FailedRun {
        chain: chain_names(&variant.recipe),
        error,
    }
}

/// The row of a variant.
fn row(variant: &Variant, mut outcome: RunOutcome) -> AblationRun {
    if let RunOutcome::Measured(run) = &mut outcome {
        // A name plays no part in what a record is known by.
        run.report.name = variant.recipe.name.clone();
    }
    AblationRun {
        outcome,
        varied: varied(variant),
        not_recorded: None,
    }
}

/// The keys that vary, with the values of a variant in words.
fn varied(variant: &Variant) -> Vec<(String, String)> {
    let pairs = variant.variations.iter();
    pairs
        .map(|one| (one.key.clone(), one.value.clone()))
        .collect()
}
