//! What is allowed in a recipe but seldom meant.

use turnpath_core::{Axis, Derivative, Tolerance};
use turnpath_post::ProgramFormat;
use turnpath_recipe::Recipe;
use turnpath_report::{ProgramDigits, Remark, RemarkSubject};

use crate::posts::{layout, posts};

/// What remarks are made on besides the recipe: its path, or what is expected of it.
pub struct PathSubject {
    /// The tolerances that the path was made for.
    pub tolerance: Tolerance,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// Control points of the cutting section.
    pub control_points: f64,
    /// The largest acceleration of Z where it is known, mm/s².
    pub z_acceleration: Option<f64>,
}

/// The remarks on a recipe and its path.
pub fn remarks(recipe: &Recipe, path: &PathSubject) -> Vec<Remark> {
    let limited = recipe
        .machine
        .limits()
        .any(|limit| limit.axis == Axis::Z && limit.derivative == Derivative::Acceleration);
    // The digits do not depend on the nose.
    let formats = posts(recipe).map(|post| layout(recipe, post, true).format);
    let coarsest = formats.min_by_key(|one| (one.position_decimals, one.velocity_decimals));
    let subject = RemarkSubject {
        aperture: 2.0 * recipe.part.aperture_radius,
        residual: path.tolerance.residual,
        interpolation: path.tolerance.interpolation,
        form: recipe.tolerances.form,
        cutting_time: path.cutting_time,
        segment_time: path.cutting_time / path.control_points.max(1.0),
        free_z_acceleration: path.z_acceleration.filter(|_| !limited),
        digits: coarsest.map(|format| digits(&format)),
    };
    subject.remarks()
}

fn digits(format: &ProgramFormat) -> ProgramDigits {
    ProgramDigits {
        position_decimals: format.position_decimals,
        velocity_decimals: format.velocity_decimals,
        velocity_time: format.velocity_time(),
    }
}
