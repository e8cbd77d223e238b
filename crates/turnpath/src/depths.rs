//! A loop of the controller over depths, as a recipe asks for it.

use turnpath_core::Params;
use turnpath_post::{DEPTH_STEP, DEPTHS, Post, ProgramError};
use turnpath_recipe::Recipe;

use crate::error::Error;

/// By how much a step may differ from a whole number of last digits, in last digits: the rounding of its unit.
const ROUNDING: f64 = 1e-6;

/// Refuses a loop over depths that the recipe does not say in full, and one around a path that does not begin
/// and end above the part.
pub fn refuse_depths(recipe: &Recipe, post: &Post, params: &Params) -> Result<(), Error> {
    let (count, step) = (
        params.find(DEPTHS).flatten(),
        params.find(DEPTH_STEP).flatten(),
    );
    let (given, missing) = match (count, step) {
        (None, None) => return Ok(()),
        (Some(_), Some(step)) if recipe.lead => return refuse_step(recipe, post, params, step),
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

/// Refuses a step, mm, that the digits of the program cannot say.
fn refuse_step(recipe: &Recipe, post: &Post, params: &Params, step: f64) -> Result<(), Error> {
    let decimals = post.format(params, 0.0, f64::INFINITY).position_decimals;
    let one = 10_u64.pow(decimals) as f64;
    let digits = (step * one).round();
    if digits >= 1.0 && (step * one - digits).abs() <= ROUNDING {
        return Ok(());
    }
    let error = ProgramError::DepthStep {
        step,
        digit: 1.0 / one,
    };
    let key = format!("{}.{}", post.table, DEPTH_STEP.name());
    let help = error.help(post.keys).to_owned();
    let diagnostic =
        recipe.diagnostic(recipe.nearest_span(&key), error.to_string(), "here", [help]);
    Err(Error::refused_by(diagnostic, error))
}
