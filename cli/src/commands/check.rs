//! `turnpath check`: everything but the path.

use turnpath::Catalogue;
use turnpath::report::text;

use super::setup;
use crate::args::CheckArgs;
use crate::print::print_report;
use crate::{Outcome, Status};

/// Checks a recipe.
pub fn check(args: &CheckArgs, catalogue: Catalogue) -> Outcome {
    let job = setup::job(&args.recipe, &args.work, catalogue)?;
    print_report(args.work.format, &job.check()?, text::check)?;
    Ok(Status::Holds)
}
