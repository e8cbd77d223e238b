//! A loop of the controller over depths, as a recipe asks for it.

use turnpath_core::Params;
use turnpath_post::{DEPTH_STEP, DEPTHS, Post, ProgramError};
use turnpath_recipe::Recipe;

use crate::error::Error;

/// Refuses a loop over depths that the recipe does not say in full, and one around a path that does not begin
/// and end above the part.
pub fn refuse_depths(recipe: &Recipe, post: &Post, params: &Params) -> Result<(), Error> {
    let (count, step) = (
        params.find(DEPTHS).flatten(),
        params.find(DEPTH_STEP).flatten(),
    );
    let (given, missing) = match (count, step) {
        (None, None) => return Ok(()),
        (Some(_), Some(_)) if recipe.lead => return Ok(()),
        (Some(_), Some(_)) => {
            let span = recipe.nearest_span(&format!("{}.{}", post.table, DEPTHS.name()));
            let title = "a loop over depths needs a path from rest to rest";
            let help =
                "write `lead = true` in [path], so that each depth begins and ends above the part";
            let diagnostic = recipe.diagnostic(span, title, "here", [help.to_owned()]);
            return Err(Error::refused_by(
                diagnostic,
                ProgramError::DepthsWithoutLeads,
            ));
        }
        (Some(_), None) => (DEPTHS.name(), DEPTH_STEP.name()),
        (None, Some(_)) => (DEPTH_STEP.name(), DEPTHS.name()),
    };
    let span = recipe.nearest_span(&format!("{}.{given}", post.table));
    let title = format!("`{given}` without `{missing}`");
    let help =
        "a loop over depths has both: how often the path is played, and how much deeper each time";
    let diagnostic = recipe.diagnostic(span, title, "here", [help.to_owned()]);
    Err(Error::refused_by(diagnostic, ProgramError::HalfOfDepths))
}
