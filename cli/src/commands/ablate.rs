//! `turnpath ablate`: the variants of a recipe side by side.

use std::num::NonZero;
use std::path::Path;

use turnpath::report::{AblationReport, comparison};
use turnpath::{AblationOptions, AblationResult, Catalogue, Recipe};
use turnpath_core::printable_line;

use super::output::refuse_output;
use super::setup;
use crate::args::AblateArgs;
use crate::print::print_report;
use crate::progress::RunsBar;
use crate::{Outcome, Status, width};

/// Makes the variants of a recipe and prints their figures. Tolerances that do not hold are what an
/// ablation shows: they do not change the exit status.
pub fn ablate(args: &AblateArgs, catalogue: Catalogue) -> Outcome {
    setup::use_threads(&args.work);
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
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
    print_report(args.work.answer(), &result.report, |report| {
        human(&recipe, &args.columns, report, &result)
    })?;
    status(result)
}

fn human(
    recipe: &Recipe,
    columns: &[String],
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
    let columns = match columns {
        [] => comparison::usual(),
        names => names
            .iter()
            .filter_map(|name| comparison::by_name(name))
            .collect(),
    };
    text += &comparison::table(&report.runs, &columns, width::of_terminal());
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
