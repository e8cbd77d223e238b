//! A part without a height somewhere, where a text of the recipe says why.

use std::f64::consts::TAU;

use turnpath_core::{Gradients, Part, Result, Scalar, Slot, SurfaceGap, SurfaceModel};
use turnpath_pipeline::{Link, PipelineError};
use turnpath_recipe::Recipe;
use turnpath_report::text::millimetres;

use crate::diagnosis::{of_pipeline, wrong_parameter};
use crate::error::Error;

/// Rings and angles at which a gap is looked for: as many as the interference check looks at first.
const RINGS: usize = 256;
/// See [`RINGS`].
const ANGLES: usize = 360;

/// An error of the preparation. Where the surface has no height on the part and knows why, the part
/// of the recipe's text is underlined that says so.
pub fn of_preparation(
    recipe: &Recipe,
    surface: &Link<dyn SurfaceModel>,
    error: PipelineError,
) -> Error {
    let no_height = matches!(
        error,
        PipelineError::NoSurface(_)
            | PipelineError::BadAnswer {
                slot: Slot::Surface,
                ..
            }
    );
    let found = no_height.then(|| first_gap(surface.strategy.as_ref(), &recipe.part));
    let Some(Ok(Some(([x, y], gap)))) = found else {
        return of_pipeline(recipe, error);
    };
    let Some(entry) = recipe.surfaces.get(gap.entry) else {
        return of_pipeline(recipe, error);
    };
    let (x, y) = (millimetres(x, 4), millimetres(y, 4));
    let message = format!("{} at x = {x}, y = {y} (part)", gap.reason);
    let diagnostic = wrong_parameter(
        recipe,
        &entry.choice,
        &gap.param,
        &message,
        Some(&gap.place),
    );
    Error::refused_by(diagnostic, error)
}

/// The innermost of many places of the part that has no height or no slope, and the reason, if the
/// surface knows it.
fn first_gap(surface: &dyn SurfaceModel, part: &Part) -> Result<Option<([f64; 2], SurfaceGap)>> {
    let width = part.aperture_radius - part.inner_radius;
    let turned: Vec<(f64, f64)> = (0..ANGLES)
        .map(|k| Scalar::sin_cos(TAU * k as f64 / ANGLES as f64))
        .collect();
    let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![0.0; ANGLES]);
    for ring in 0..=RINGS {
        let rho = part.inner_radius + width * ring as f64 / RINGS as f64;
        let x: Vec<f64> = turned.iter().map(|(_, cos)| rho * cos).collect();
        let y: Vec<f64> = turned.iter().map(|(sin, _)| rho * sin).collect();
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(&x, &y, out)?;
        let is_gap = |k: &usize| {
            ![z[*k], zx[*k], zy[*k]]
                .iter()
                .all(|value| value.is_finite())
        };
        if let Some(k) = (0..ANGLES).find(is_gap) {
            let gap = surface.gap(x[k], y[k])?;
            return Ok(gap.map(|gap| ([x[k], y[k]], gap)));
        }
    }
    Ok(None)
}
