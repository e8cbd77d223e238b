//! An ablation: the variants of a recipe made, measured and set side by side.
//!
//! Every run leaves a record in `DIR/runs`, named by the hash of all that the run depends on. A run
//! whose record is there is not made again, so an interrupted ablation goes on where it stopped.

mod clock;
mod files;
mod key;
mod observer;
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
use crate::strategies::wrong_choices;

use files::AblationFiles;
use key::{Key, Keys};
pub use observer::AblationObserver;
use record::Records;
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
    /// The file whose hash stands for the program in the keys of runs; the one that runs unless
    /// given. A library inside of another program gives its own.
    pub program: Option<PathBuf>,
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
    let variants = recipe.variants()?;
    refuse_wrong_choices(&variants, catalogue)?;
    let data = DataFiles::default();
    let keys = Keys::new(catalogue, &data, options.program.as_deref()).of_all(&variants)?;
    let files = AblationFiles::new(&options.folder)?;
    let records = Records::new(files.folder())?;
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
        |index, run| match keys.get(index) {
            Some(key) => records.keep(files.folder(), key, run),
            None => Err(Error::RunLost),
        },
    )?;
    let (runs, failures) = rows(&variants, outcomes);
    let report = AblationReport::new(runs);
    Ok(AblationResult {
        files: files.write(&report)?,
        report,
        reused,
        failures,
    })
}

/// Strategies that are not there, or do not take the parameters that the lists give them, are
/// refused before the work.
fn refuse_wrong_choices(variants: &[Variant], catalogue: &Catalogue) -> Result<(), Error> {
    let mut all: Vec<Diagnostic> = Vec::new();
    for variant in variants {
        for diagnostic in wrong_choices(&variant.recipe, catalogue) {
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
    let one = |key| match options.fresh {
        true => None,
        false => records.read(key, observer),
    };
    keys.iter().map(one).collect()
}

/// The rows of the report, and why runs failed.
fn rows(variants: &[Variant], outcomes: Vec<Outcome>) -> (Vec<AblationRun>, Vec<(usize, Error)>) {
    let (mut runs, mut failures) = (Vec::new(), Vec::new());
    for (index, (variant, outcome)) in variants.iter().zip(outcomes).enumerate() {
        let outcome = match outcome {
            Ok(mut run) => {
                // A name plays no part in what a record is known by.
                run.report.name = variant.recipe.name.clone();
                RunOutcome::Measured(Box::new(run))
            }
            Err(error) => {
                let row = FailedRun {
                    chain: chain_names(&variant.recipe),
                    error: error.title(),
                };
                failures.push((index, error));
                RunOutcome::Failed(row)
            }
        };
        let varied = variant.variations.iter();
        let varied = varied.map(|one| (one.key.clone(), one.value.clone()));
        runs.push(AblationRun {
            outcome,
            varied: varied.collect(),
        });
    }
    (runs, failures)
}
