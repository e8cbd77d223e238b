//! A part without a height somewhere, where a text of the recipe says why.

use turnpath_core::{
    GradientSeries, Gradients, Part, Result, Scalar, Series, Slot, SurfaceGap, SurfaceModel,
    even_angles,
};
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

/// The innermost of many places of the part that has no height or no slope, else the innermost that
/// has no derivatives, and the reason, if the surface knows it.
fn first_gap(surface: &dyn SurfaceModel, part: &Part) -> Result<Option<([f64; 2], SurfaceGap)>> {
    let width = part.aperture_radius - part.inner_radius;
    let turned: Vec<(f64, f64)> = even_angles(ANGLES).map(Scalar::sin_cos).collect();
    let rings = (0..=RINGS).map(|ring| {
        let rho = part.inner_radius + width * ring as f64 / RINGS as f64;
        let places = turned.iter().map(|(sin, cos)| [rho * cos, rho * sin]);
        places.collect::<Vec<[f64; 2]>>()
    });
    let rings: Vec<Vec<[f64; 2]>> = rings.collect();
    for has_gap in [without_slope, without_derivatives] {
        for ring in &rings {
            if let Some([x, y]) = has_gap(surface, ring)? {
                let gap = surface.gap(x, y)?;
                return Ok(gap.map(|gap| ([x, y], gap)));
            }
        }
    }
    Ok(None)
}

/// The first place without a height or a slope.
fn without_slope(surface: &dyn SurfaceModel, places: &[[f64; 2]]) -> Result<Option<[f64; 2]>> {
    let (x, y): (Vec<f64>, Vec<f64>) = places.iter().map(|[x, y]| (*x, *y)).unzip();
    let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![0.0; places.len()]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&x, &y, out)?;
    let figures = z.iter().zip(zx.iter().zip(&zy));
    let mut all = places.iter().zip(figures);
    let found = all.find(|(_, (z, (zx, zy)))| ![z, zx, zy].iter().all(|one| one.is_finite()));
    Ok(found.map(|(place, _)| *place))
}

/// The first place without derivatives of height and slope along x or along y.
fn without_derivatives(
    surface: &dyn SurfaceModel,
    places: &[[f64; 2]],
) -> Result<Option<[f64; 2]>> {
    let line = |from: f64, rate: f64| [from, rate, 0.0, 0.0, 0.0];
    let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![[0.0; 5]; places.len()]);
    for [rate_x, rate_y] in [[1.0, 0.0], [0.0, 1.0]] {
        let x: Vec<Series> = places.iter().map(|[x, _]| line(*x, rate_x)).collect();
        let y: Vec<Series> = places.iter().map(|[_, y]| line(*y, rate_y)).collect();
        let (z, zx, zy) = (&mut z, &mut zx, &mut zy);
        surface.series(&x, &y, GradientSeries { z, zx, zy })?;
        let is_gap = |k: &usize| {
            let mut all = z[*k].iter().chain(&zx[*k]).chain(&zy[*k]);
            !all.all(|one| one.is_finite())
        };
        if let Some(k) = (0..places.len()).find(is_gap) {
            return Ok(Some(places[k]));
        }
    }
    Ok(None)
}
