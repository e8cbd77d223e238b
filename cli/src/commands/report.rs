//! `turnpath report`: the pages of results that are there already.

use turnpath::{Catalogue, PageRequest, result_recipe, with_listed_plugins, write_page};
use turnpath_core::printable_line;

use super::setup::{refuse_listed_plugins, use_so_many, with_plugins};
use crate::args::ReportArgs;
use crate::print::print;
use crate::progress::Bar;
use crate::{Outcome, Status};

/// Makes the page of each result, and prints its path.
pub fn report(args: &ReportArgs, catalogue: Catalogue) -> Outcome {
    use_so_many(args.threads);
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    for folder in &args.folders {
        let request = PageRequest {
            folder: folder.clone(),
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
        let bar = Bar::new();
        let page = write_page(&request, &catalogue, &bar);
        bar.clear();
        let page = page?.display().to_string();
        print(&format!("{}\n", printable_line(&page)))?;
    }
    Ok(Status::Holds)
}
