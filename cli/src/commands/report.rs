//! `turnpath report`: the pages of results that are there already.

use std::path::Path;

use serde::Serialize;
use turnpath::{
    Catalogue, DrawingRequest, PageRequest, report, result_recipe, with_listed_plugins, write_page,
};
use turnpath_core::printable_line;

use super::drawings;
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
    let drawings = drawings::requests(&args.drawings)?;
    refuse_shared_files(args, &drawings)?;
    let mut files = Vec::new();
    for folder in &args.folders {
        files.extend(page(args, &catalogue, folder, &drawings)?);
    }
    let pages = Pages {
        format: report::FORMAT,
        files,
    };
    print_report(args.work.answer(), &pages, |pages| {
        let line = |file: &String| format!("  file            {}\n", printable_line(file));
        pages.files.iter().map(line).collect()
    })?;
    Ok(Status::Holds)
}

/// The plots of several results cannot go to one place.
fn refuse_shared_files(args: &ReportArgs, drawings: &[DrawingRequest]) -> Result<(), Failure> {
    let shared = drawings.iter().find(|drawing| drawing.file.is_absolute());
    match shared.filter(|_| args.folders.len() > 1) {
        Some(drawing) => Err(Failure::Call(format!(
            "--plot {}: give a relative name, which is taken from each folder",
            drawing.file.display()
        ))),
        None => Ok(()),
    }
}

/// Makes the page of a result and its plots; gives their paths.
fn page(
    args: &ReportArgs,
    catalogue: &Catalogue,
    folder: &Path,
    drawings: &[DrawingRequest],
) -> Result<Vec<String>, Failure> {
    let request = PageRequest {
        folder: folder.to_owned(),
        recipe: args.recipe.clone(),
        drawings: drawings.to_vec(),
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
    let files = write_page(&request, &catalogue, &bar);
    bar.clear();
    let paths = files?.into_iter();
    Ok(paths.map(|path| path.display().to_string()).collect())
}
