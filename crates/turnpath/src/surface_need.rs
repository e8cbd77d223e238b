//! What a recipe needs of a surface that stands for a function.

use turnpath_core::{Overrun, Scalar};
use turnpath_host::SurfaceNeed;
use turnpath_recipe::{Recipe, SurfaceEntry};

/// The share of the interpolation tolerance that the error of a surface takes before it counts. A
/// smaller share makes splines finer, and so their data larger; a larger one is seen in the path.
const SHARE: f64 = 0.05;

/// How far one surface of a recipe is asked about its own origin, and how exact it must be.
pub fn surface_need(recipe: &Recipe, entry: &SurfaceEntry) -> SurfaceNeed {
    let overrun = match recipe.overrun {
        Overrun::Length(length) => length,
        Overrun::Contact | Overrun::None => 0.0,
    };
    let part = recipe.part.aperture_radius + recipe.tool.nose_radius + overrun;
    let place = &entry.placement;
    let away = Scalar::hypot(place.decentre_x, place.decentre_y);
    let pose = recipe
        .pose
        .map_or(0.0, |pose| Scalar::hypot(pose.x, pose.y));
    let scale = match place.scale.abs() {
        0.0 => 1.0,
        scale => scale,
    };
    SurfaceNeed {
        half_width: part + away + pose,
        error: SHARE * recipe.tolerance.interpolation / scale,
    }
}
