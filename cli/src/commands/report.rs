//! `turnpath report`: the pages of results that are there already.

use std::path::Path;

use serde::Serialize;
use turnpath::{Catalogue, PageRequest, report, result_recipe, with_listed_plugins, write_page};
use turnpath_core::printable_line;

use super::setup::{refuse_listed_plugins, use_threads, with_plugins};
use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::print::print_report;
use crate::progress::Bar;
use crate::{Outcome, Status};

/// The pages that were made.
#[derive(Serialize)]
struct Pages {
    format: u32,
    files: Vec<String>,
}

/// Makes the page of each result.
pub fn report(args: &ReportArgs, catalogue: Catalogue) -> Outcome {
    use_threads(&args.work);
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    let page = |folder| page(args, &catalogue, folder);
    let folders = args.folders.iter().map(AsRef::as_ref);
    let pages = Pages {
        format: report::FORMAT,
        files: folders.map(page).collect::<Result<_, _>>()?,
    };
    print_report(args.work.answer(), &pages, |pages| {
        let line = |file: &String| format!("  file            {}\n", printable_line(file));
        pages.files.iter().map(line).collect()
    })?;
    Ok(Status::Holds)
}

/// Makes the page of a result; gives its path.
fn page(args: &ReportArgs, catalogue: &Catalogue, folder: &Path) -> Result<String, Failure> {
    let request = PageRequest {
        folder: folder.to_owned(),
        recipe: args.recipe.clone(),
    };
    let catalogue = match result_recipe(&request)? {
        None => catalogue.clone(),
        Some(recipe) => {
            if !args.trust_recipe {
                refuse_listed_plugins(&recipe)?;
            }
            with_listed_plugins(catalogue.clone(), &recipe)?
        }
    };
    let bar = Bar::new(&args.work);
    let page = write_page(&request, &catalogue, &bar);
    bar.clear();
    Ok(page?.display().to_string())
}
