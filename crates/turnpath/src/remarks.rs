//! What is allowed in a recipe but seldom meant.

use turnpath_core::{Axis, Derivative};
use turnpath_recipe::Recipe;
use turnpath_report::{Remark, RemarkSubject};

/// The remarks on a recipe and its path, with the largest acceleration of Z where it is known,
/// mm/s².
pub fn remarks(recipe: &Recipe, cutting_time: f64, z_acceleration: Option<f64>) -> Vec<Remark> {
    let limited = recipe
        .machine
        .limits()
        .any(|limit| limit.axis == Axis::Z && limit.derivative == Derivative::Acceleration);
    let has_program = !recipe.output.posts.is_empty();
    let subject = RemarkSubject {
        aperture: 2.0 * recipe.part.aperture_radius,
        residual: recipe.tolerance.residual,
        interpolation: recipe.tolerance.interpolation,
        cutting_time,
        free_z_acceleration: z_acceleration.filter(|_| !limited),
        position_decimals: has_program.then_some(recipe.pmac_pvt.position_decimals),
    };
    subject.remarks()
}
