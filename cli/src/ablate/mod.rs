//! `turnpath ablate`: the variants of a recipe made, measured and set side by side.
//!
//! Every run leaves a record in `DIR/runs`, named by the hash of all that the run depends on. A run
//! whose record is there is not made again, so an interrupted ablation goes on where it stopped.

mod clock;
pub mod columns;
mod key;
mod one;
mod record;
mod report;
mod runs;
mod table;

use std::path::{Path, PathBuf};

use turnpath_host::Catalogue;
use turnpath_recipe::{Recipe, Variant};

use crate::args::{AblateArgs, Format};
use crate::failure::Failure;
use crate::job::use_threads;
use crate::run::print;
use crate::summary::to_json;
use crate::{Done, Verdict, strategies};

use key::Keys;
use one::Made;
use record::Records;
use report::Report;

/// What a variant gave: its figures, or why there are none.
type Outcome = Result<Made, Failure>;

/// Makes the variants of a recipe and writes their figures. Tolerances that do not hold are what
/// an ablation is to show: they do not change the exit status.
pub fn ablate(args: &AblateArgs) -> Done {
    use_threads(&args.work);
    let recipe = Recipe::load(&args.recipe.recipe, &args.recipe.set)?;
    let variants = recipe.variants()?;
    let catalogue = strategies::catalogue_for(&recipe, &args.recipe)?;
    refuse_wrong_strategies(&variants, &catalogue)?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(format!("{}-ablation", recipe.folder_name())),
    };
    let report = Report::ready(&folder)?;
    let records = Records::ready(&folder)?;
    let keys = Keys::new(&catalogue).of_all(&variants);
    let before = taken_over(args, &records, &keys);
    let count = before.iter().flatten().count();
    let threads = args.work.threads.map(usize::from);
    let outcomes = runs::make_rest(&variants, &catalogue, before, threads, |index, made| {
        let key = keys.get(index).ok_or_else(no_key)?;
        records.keep(key, made)
    })?;
    let entries = report::entries(&variants, &outcomes);
    let written = report.write(&variants, &entries)?;
    print(&match args.work.format {
        Format::Json => to_json(&report::document(&entries)),
        Format::Human => human(&recipe, &args.columns, &entries, count, &written),
    })?;
    verdict(outcomes)
}

fn no_key() -> Failure {
    Failure::call("a run without a key")
}

/// Strategies that are not there, or do not take the parameters that the lists give them, are told
/// before the work.
fn refuse_wrong_strategies(variants: &[Variant], catalogue: &Catalogue) -> Result<(), Failure> {
    let mut texts: Vec<String> = Vec::new();
    for variant in variants {
        for failure in strategies::complaints(&variant.recipe, catalogue) {
            let text = failure.text().to_owned();
            if !texts.contains(&text) {
                texts.push(text);
            }
        }
    }
    match texts.is_empty() {
        true => Ok(()),
        false => Err(Failure::Wrong(texts.join("\n\n"))),
    }
}

/// The runs that were made before.
fn taken_over(args: &AblateArgs, records: &Records, keys: &[key::Key]) -> Vec<Option<Made>> {
    let one = |key| match args.fresh {
        true => None,
        false => records.take_over(key),
    };
    keys.iter().map(one).collect()
}

fn human(
    recipe: &Recipe,
    columns: &[String],
    entries: &[serde_json::Value],
    taken_over: usize,
    written: &[PathBuf],
) -> String {
    let failed = entries.iter().filter(|entry| entry.get("error").is_some());
    let mut text = format!("{}: {} runs", recipe.name, entries.len());
    for (count, what) in [
        (taken_over, "taken over from before"),
        (failed.count(), "failed"),
    ] {
        if count > 0 {
            text += &format!(", {count} {what}");
        }
    }
    text += "\n\n";
    text += &table::table(entries, &columns::chosen(columns), table::of_terminal());
    text.push('\n');
    for file in written {
        text += &format!("  file  {}\n", file.display());
    }
    text
}

/// A failed run is a row of the table. Where all failed there is nothing but the reason.
fn verdict(outcomes: Vec<Outcome>) -> Done {
    if outcomes.iter().any(Result::is_ok) {
        return Ok(Verdict::Holds);
    }
    match outcomes.into_iter().next() {
        Some(Err(failure)) => Err(failure),
        _ => Ok(Verdict::Holds),
    }
}
