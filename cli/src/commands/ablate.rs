//! `turnpath ablate`: the variants of a recipe side by side.

use std::collections::BTreeSet;
use std::num::NonZero;
use std::path::Path;

use turnpath::report::comparison::{Column, Language};
use turnpath::report::{AblationReport, AblationRun, comparison, to_json};
use turnpath::{
    AblationOptions, AblationPlan, AblationResult, Catalogue, PackedAblation, Recipe, RunState,
};
use turnpath_core::printable_line;

use super::output::refuse_output;
use super::setup;
use crate::args::{AblateArgs, PlanForm, TableLanguage};
use crate::print::{print, print_report};
use crate::progress::RunsBar;
use crate::{Outcome, Status, width};

/// Makes the variants of a recipe and prints their figures. Tolerances that do not hold are what an
/// ablation shows: they do not change the exit status.
pub fn ablate(args: &AblateArgs, catalogue: Catalogue) -> Outcome {
    setup::use_threads(&args.work);
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    if let Some(folder) = &args.pack {
        refuse_output(Some(folder), "--pack")?;
        let packed = turnpath::pack_ablation(&recipe, &catalogue, folder)?;
        print(&packed_text(&packed, args.recipe.trust_recipe))?;
        return Ok(Status::Holds);
    }
    let recipe = match args.equal_tolerance {
        true => recipe.set("refine", "true")?,
        false => recipe,
    };
    refuse_output(args.output.as_deref(), "-o")?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(format!("{}-ablation", recipe.folder_name())),
    };
    if let Some(form) = args.plan {
        let plan = turnpath::plan_ablation(&recipe, &catalogue, &folder)?;
        print(&plan_text(&plan, form))?;
        return Ok(Status::Holds);
    }
    let bar = RunsBar::new(&args.work);
    if let Some(key) = &args.only {
        let run = turnpath::run_of_ablation(&recipe, &catalogue, &folder, key, &bar)?;
        print_report(args.work.answer(), &run, |run| one_run(run, key))?;
        return Ok(Status::Holds);
    }
    let options = AblationOptions {
        folder,
        fresh: args.fresh,
        threads: args
            .work
            .threads
            .and_then(|count| NonZero::new(usize::from(count))),
    };
    let result = match args.merge {
        true => turnpath::merge_ablation(&recipe, &catalogue, &options.folder, &bar)?,
        false => turnpath::ablate(&recipe, &catalogue, &options, &bar)?,
    };
    match args.table {
        Some(language) => print(&table_alone(args, language, &result.report))?,
        None => print_report(args.work.answer(), &result.report, |report| {
            human(&recipe, args, report, &result)
        })?,
    }
    status(result)
}

fn plan_text(plan: &AblationPlan, form: PlanForm) -> String {
    match form {
        PlanForm::Json => to_json(plan),
        PlanForm::Open => {
            let open = plan.runs.iter().filter(|run| run.state != RunState::Done);
            open.map(|run| format!("{}\n", run.key)).collect()
        }
    }
}

/// What was packed, and the call that plans with it, with the trust that packing took.
fn packed_text(packed: &PackedAblation, is_trusted: bool) -> String {
    let said = |path: &Path| printable_line(&path.display().to_string()).into_owned();
    let files = packed.files.iter();
    let mut text: String = files
        .map(|file| format!("  file  {}\n", said(file)))
        .collect();
    let recipe = packed.recipe.file_name().unwrap_or_default();
    let plugins = match packed.has_plugins {
        true => " --plugin-dir plugins --plugins-lock plugins.lock",
        false => "",
    };
    let trust = if is_trusted { " --trust-recipe" } else { "" };
    text += &format!(
        "\nIn this folder, on any machine: turnpath ablate {}{plugins}{trust} -o . --only KEY\n",
        said(Path::new(recipe))
    );
    text
}

/// A line on a run that was made alone.
fn one_run(run: &AblationRun, key: &str) -> String {
    let values = run.varied.iter().map(|(_, value)| value.as_str());
    let values: Vec<&str> = values.collect();
    format!("{key}: {}\n", printable_line(&values.join(", ")))
}

/// The runs in the order that was asked for.
fn ordered(args: &AblateArgs, report: &AblationReport) -> Vec<AblationRun> {
    let column = args.sort.as_deref().and_then(comparison::by_name);
    column.map_or_else(
        || report.runs.clone(),
        |column| comparison::sorted(&report.runs, column),
    )
}

/// The run to which ratios are: the first of the ablation, in whatever order the rows stand.
fn base<'a>(args: &AblateArgs, report: &'a AblationReport) -> Option<&'a AblationRun> {
    report.runs.first().filter(|_| !args.no_ratio)
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
    comparison::paper_table(&runs, &columns, language, base(args, report))
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
        (result.without_figures, "without figures"),
    ] {
        if count > 0 {
            text += &format!(", {count} {what}");
        }
    }
    text += "\n\n";
    text += &not_recorded(report);
    let (runs, columns) = (ordered(args, report), columns(args));
    text += &comparison::table(&runs, &columns, width::of_terminal(), base(args, report));
    text.push('\n');
    for file in &result.files {
        text += &format!("  file  {}\n", printable_line(&file.display().to_string()));
    }
    text
}

/// The runs that are made each time, and why.
fn not_recorded(report: &AblationReport) -> String {
    let reasons = report
        .runs
        .iter()
        .filter_map(|run| run.not_recorded.as_ref());
    let reasons: Vec<&String> = reasons.collect();
    let distinct: BTreeSet<&String> = reasons.iter().copied().collect();
    let of = |why: &String| {
        let count = reasons.iter().filter(|one| **one == why).count();
        let runs = if count == 1 { "run has" } else { "runs have" };
        format!(
            "  {count} {runs} no record, because of {}\n",
            printable_line(why)
        )
    };
    let mut text: String = distinct.into_iter().map(of).collect();
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// A failed run is a row of the table. Where all failed there is nothing but the reason.
fn status(result: AblationResult) -> Outcome {
    let all_failed = result.failures.len() == result.report.runs.len();
    match result.failures.into_iter().next() {
        Some((_, error)) if all_failed => Err(error.into()),
        _ if result.without_figures > 0 => Ok(Status::Exceeded),
        _ => Ok(Status::Holds),
    }
}
