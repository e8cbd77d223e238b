//! What a file of a tool path is measured against.

use turnpath_core::{Misfit, Tool};
use turnpath_host::Catalogue;
use turnpath_pipeline::{LocusLinks, prepare};
use turnpath_recipe::Recipe;
use turnpath_verify::Subject;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::strategies::compensator;
use crate::surface::surface;

/// The surface and the compensator of a recipe.
///
/// # Errors
/// When one of them is not there or refuses its parameters.
pub fn locus_links(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<LocusLinks, Error> {
    Ok(LocusLinks {
        surface: surface(recipe, catalogue, files)?,
        compensator: compensator(recipe, catalogue, files)?,
    })
}

/// The subject of a recipe, with its surface and its compensator.
pub fn subject(recipe: &Recipe, links: &LocusLinks) -> Subject {
    Subject {
        surface: links.surface.strategy.clone(),
        part: recipe.part,
        tool: tool(recipe, links),
        compensates_nose: links.compensator.strategy.compensates_nose(),
    }
}

/// The tool as a run of the recipe takes it: where the whole tool fits, nothing has to be left, though the recipe
/// would allow it. Where the part refuses the tool, the recipe's own tool counts.
fn tool(recipe: &Recipe, links: &LocusLinks) -> Tool {
    if recipe.tool.misfit == Misfit::Refuse {
        return recipe.tool;
    }
    let preparation = prepare(links, recipe.job_spec());
    preparation.map_or(recipe.tool, |preparation| preparation.task.tool)
}
