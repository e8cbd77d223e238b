//! What a file of a tool path is measured against.

use std::sync::Arc;

use turnpath_core::{Misfit, SurfaceModel, Tool};
use turnpath_host::Catalogue;
use turnpath_recipe::Recipe;
use turnpath_verify::Subject;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::job::Job;
use crate::strategies;

/// The subject of a recipe with its surface.
///
/// # Errors
/// When the compensator is not there, or fails.
pub fn subject(
    (recipe, catalogue, files): (&Recipe, &Catalogue, &DataFiles),
    surface: Arc<dyn SurfaceModel>,
) -> Result<Subject, Error> {
    let compensator = strategies::compensator(recipe, catalogue, files)?.strategy;
    Ok(Subject {
        surface,
        part: recipe.part,
        tool: tool(recipe, catalogue, files),
        compensates_nose: compensator.compensates_nose(),
    })
}

/// The tool as a run of the recipe takes it: where the whole tool fits, nothing has to be left, though the recipe
/// would allow it. A recipe that cannot be run says itself what its tool does.
fn tool(recipe: &Recipe, catalogue: &Catalogue, files: &DataFiles) -> Tool {
    if recipe.tool.misfit == Misfit::Refuse {
        return recipe.tool;
    }
    let job = Job::with_files(recipe.clone(), catalogue, files);
    job.map_or(recipe.tool, |job| job.preparation.task.tool)
}
