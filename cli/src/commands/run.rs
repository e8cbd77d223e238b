//! `turnpath run`: the whole pipeline, and its files.

use std::path::Path;

use turnpath::report::text;
use turnpath::{Catalogue, Outputs};

use super::output::refuse_output;
use super::{drawings, plots, setup};
use crate::args::RunArgs;
use crate::print::print_report;
use crate::progress::Bar;
use crate::{Outcome, Status};

/// Runs a recipe and writes its files.
pub fn run(args: &RunArgs, catalogue: Catalogue) -> Outcome {
    refuse_output(args.output.as_deref(), "-o")?;
    let job = setup::job(&args.recipe, &args.work, catalogue)?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(job.recipe().folder_name()),
    };
    let outputs = Outputs::in_folder(folder)
        .with_drawings(drawings::requests(&args.drawings)?)
        .with_plots(plots::request(&args.plots)?)
        .with_dry_run(args.dry_run)
        .with_page(!args.no_report);
    let bar = Bar::new(&args.work);
    let result = job.run(outputs, &bar);
    bar.clear();
    let result = result?;
    print_report(args.work.answer(), &result.report, |report| {
        text::run(report, &result.files)
    })?;
    Ok(Status::of(result.report.verdict()))
}
