//! `turnpath check`: everything but the path.

use turnpath::report::text;
use turnpath::{Catalogue, Error, Job, Recipe, refused_check};

use super::setup;
use crate::args::{CheckArgs, WorkArgs};
use crate::failure::Failure;
use crate::print::print_report;
use crate::progress::Bar;
use crate::{Outcome, Status};

/// Checks a recipe.
pub fn check(args: &CheckArgs, catalogue: Catalogue) -> Outcome {
    setup::use_threads(&args.work);
    let (recipe, catalogue) = setup::trusted_recipe(&args.recipe, catalogue)?;
    // A thread of the pool begins. The first thread would only hand its parts over and wait. The two threads that
    // then wake up share one processor now and then, for some milliseconds.
    let report = rayon::scope(|_| {
        let job = Job::new(recipe.clone(), &catalogue)?;
        let bar = Bar::new(&args.work);
        let report = job.check(&bar);
        bar.clear();
        report
    });
    match report {
        Ok(report) => print_report(args.work.answer(), &report, text::check)?,
        Err(error) => {
            print_part(&args.work, &recipe, &catalogue, &error)?;
            return Err(error.into());
        }
    }
    Ok(Status::Holds)
}

/// Prints what is known of the part of a refused recipe; nothing where its surface is what is wrong.
fn print_part(
    work: &WorkArgs,
    recipe: &Recipe,
    catalogue: &Catalogue,
    error: &Error,
) -> Result<(), Failure> {
    match (error, refused_check(recipe, catalogue, error)) {
        (Error::Refused { .. }, Ok(report)) => {
            print_report(work.answer(), &report, text::refused_check)
        }
        _ => Ok(()),
    }
}
