//! `turnpath verify`: any tool path against a recipe's surface, tool and tolerances.

use std::path::Path;

use turnpath::Catalogue;
use turnpath::report::text;

use super::output::refuse_output;
use super::{plots, setup};
use crate::args::VerifyArgs;
use crate::failure::Failure;
use crate::print::print_report;
use crate::progress::Bar;
use crate::{Outcome, Status};

/// Measures a file.
pub fn verify(args: &VerifyArgs, catalogue: Catalogue) -> Outcome {
    refuse_output(args.output.as_deref(), "-o")?;
    refuse_lone_recipe(args)?;
    setup::use_threads(&args.work);
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    let request = plots::request(&args.plots)?;
    let folder = args.output.as_deref().unwrap_or(Path::new("."));
    let bar = Bar::new(&args.work);
    let report = turnpath::verify(&recipe, &catalogue, &args.file, &request, folder, &bar);
    bar.clear();
    let report = report?;
    print_report(args.work.answer(), &report, text::file)?;
    Ok(Status::of(report.verdict()))
}

/// One name alone is that of the path's file, and a recipe is none.
fn refuse_lone_recipe(args: &VerifyArgs) -> Result<(), Failure> {
    let is_recipe = args.file.extension().is_some_and(|ending| ending == "toml");
    match args.recipe.recipe.is_none() && is_recipe {
        true => Err(Failure::Call(format!(
            "give the file to measure too: `turnpath verify {} FILE`",
            args.file.display()
        ))),
        false => Ok(()),
    }
}
