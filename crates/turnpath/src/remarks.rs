//! What is allowed in a recipe but seldom meant.

use turnpath_core::{Axis, Derivative, Tolerance};
use turnpath_recipe::{PmacPvt, Recipe};
use turnpath_report::{ProgramDigits, Remark, RemarkSubject};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;

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
    let has_program = !recipe.output.posts.is_empty();
    let subject = RemarkSubject {
        aperture: 2.0 * recipe.part.aperture_radius,
        residual: path.tolerance.residual,
        interpolation: path.tolerance.interpolation,
        form: recipe.tolerances.form,
        cutting_time: path.cutting_time,
        segment_time: path.cutting_time / path.control_points.max(1.0),
        free_z_acceleration: path.z_acceleration.filter(|_| !limited),
        digits: has_program.then(|| digits(&recipe.pmac_pvt)),
    };
    subject.remarks()
}

fn digits(settings: &PmacPvt) -> ProgramDigits {
    ProgramDigits {
        position_decimals: settings.position_decimals,
        velocity_decimals: settings.velocity_decimals,
        velocity_time: if settings.per_minute { MINUTE } else { 1.0 },
    }
}
