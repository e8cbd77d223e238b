//! What a recipe says of the job, for the pipeline.

use turnpath_pipeline::JobSpec;
use turnpath_recipe::Recipe;

/// The recipe's part, tool, tolerances and machine.
pub fn job_spec(recipe: &Recipe) -> JobSpec {
    JobSpec {
        part: recipe.part,
        tool: recipe.tool,
        tolerance: recipe.tolerance,
        overrun: recipe.overrun,
        direction: recipe.direction,
        spindle_speed: recipe.spindle_speed,
        machine: recipe.machine,
    }
}
