//! `turnpath ablate`: the variants of a recipe side by side.

use std::num::NonZero;
use std::path::Path;

use turnpath::report::comparison::{Column, Language};
use turnpath::report::{AblationReport, AblationRun, comparison};
use turnpath::{AblationOptions, AblationResult, Catalogue, Recipe};
use turnpath_core::printable_line;

use super::output::refuse_output;
use super::setup;
use crate::args::{AblateArgs, TableLanguage};
use crate::print::{print, print_report};
use crate::progress::RunsBar;
use crate::{Outcome, Status, width};

/// Makes the variants of a recipe and prints their figures. Tolerances that do not hold are what an
/// ablation shows: they do not change the exit status.
pub fn ablate(args: &AblateArgs, catalogue: Catalogue) -> Outcome {
    setup::use_threads(&args.work);
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    let recipe = match args.equal_tolerance {
        true => recipe.set("refine", "true")?,
        false => recipe,
    };
    refuse_output(args.output.as_deref(), "-o")?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(format!("{}-ablation", recipe.folder_name())),
    };
    let options = AblationOptions {
        folder,
        fresh: args.fresh,
        threads: args
            .work
            .threads
            .and_then(|count| NonZero::new(usize::from(count))),
    };
    let result = turnpath::ablate(&recipe, &catalogue, &options, &RunsBar::new(&args.work))?;
    match args.table {
        Some(language) => print(&table_alone(args, language, &result.report))?,
        None => print_report(args.work.answer(), &result.report, |report| {
            human(&recipe, args, report, &result)
        })?,
    }
    status(result)
}

/// The runs in the order that was asked for.
fn ordered(args: &AblateArgs, report: &AblationReport) -> Vec<AblationRun> {
    let column = args.sort.as_deref().and_then(comparison::by_name);
    column.map_or_else(
        || report.runs.clone(),
        |column| comparison::sorted(&report.runs, column),
    )
}

fn columns(args: &AblateArgs) -> Vec<&'static Column> {
    match args.columns.as_slice() {
        [] => comparison::usual(),
        names => names
            .iter()
            .filter_map(|name| comparison::by_name(name))
            .collect(),
    }
}

fn table_alone(args: &AblateArgs, language: TableLanguage, report: &AblationReport) -> String {
    let language = match language {
        TableLanguage::Markdown => Language::Markdown,
        TableLanguage::Latex => Language::Latex,
        TableLanguage::Csv => Language::Csv,
    };
    let (runs, columns) = (ordered(args, report), columns(args));
    comparison::paper_table(&runs, &columns, language, !args.no_ratio)
}

fn human(
    recipe: &Recipe,
    args: &AblateArgs,
    report: &AblationReport,
    result: &AblationResult,
) -> String {
    let mut text = format!(
        "{}: {} runs",
        printable_line(&recipe.name),
        report.runs.len()
    );
    for (count, what) in [
        (result.reused, "taken over from before"),
        (result.failures.len(), "failed"),
    ] {
        if count > 0 {
            text += &format!(", {count} {what}");
        }
    }
    text += "\n\n";
    let (runs, columns) = (ordered(args, report), columns(args));
    text += &comparison::table(&runs, &columns, width::of_terminal(), !args.no_ratio);
    text.push('\n');
    for file in &result.files {
        text += &format!("  file  {}\n", printable_line(&file.display().to_string()));
    }
    text
}

/// A failed run is a row of the table. Where all failed there is nothing but the reason.
fn status(result: AblationResult) -> Outcome {
    let all_failed = result.failures.len() == result.report.runs.len();
    match result.failures.into_iter().next() {
        Some((_, error)) if all_failed => Err(error.into()),
        _ => Ok(Status::Holds),
    }
}
