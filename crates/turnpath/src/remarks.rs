//! What is allowed in a recipe but seldom meant.

use turnpath_core::{Axis, Derivative, Tolerance};
use turnpath_post::ProgramFormat;
use turnpath_recipe::Recipe;
use turnpath_report::{ProgramDigits, Remark, RemarkSubject};

use crate::posts::{layout, posts};

/// Decimals of velocities that are never too few.
const NOT_COARSE: u32 = 12;

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
    let formats: Vec<ProgramFormat> = formats.collect();
    let subject = RemarkSubject {
        aperture: 2.0 * recipe.part.aperture_radius,
        residual: path.tolerance.residual,
        interpolation: path.tolerance.interpolation,
        form: recipe.tolerances.form,
        cutting_time: path.cutting_time,
        segment_time: path.cutting_time / path.control_points.max(1.0),
        free_z_acceleration: path.z_acceleration.filter(|_| !limited),
        digits: digits(&formats),
    };
    subject.remarks()
}

/// The coarsest digits of these programs. Those of straight lines have no velocities.
fn digits(formats: &[ProgramFormat]) -> Option<ProgramDigits> {
    let position_decimals = formats.iter().map(|one| one.position_decimals).min()?;
    let cubics = formats.iter().filter(|one| one.chords.is_none());
    let coarsest = cubics.min_by_key(|one| one.velocity_decimals);
    Some(ProgramDigits {
        position_decimals,
        velocity_decimals: coarsest.map_or(NOT_COARSE, |one| one.velocity_decimals),
        velocity_time: coarsest.map_or(1.0, ProgramFormat::velocity_time),
    })
}
