//! Whether the surface is there where the part lies: before any search on the part runs.

use std::f64::consts::TAU;

use turnpath_core::{Part, Scalar, StrategyError, SurfaceModel, even_angles};

use crate::{Link, PipelineError, Result};

/// Rings of the part at which the surface is looked for, besides the inner one.
const RINGS: usize = 8;
/// Points on a ring.
const RING_POINTS: usize = 8;

/// Rings and angles at which a map is looked for. A map between two of these places is told by how
/// far the part leaves it.
const MAP_RINGS: usize = 100;
/// See [`MAP_RINGS`].
const MAP_ANGLES: usize = 360;

/// The largest height that a surface may have, mm: a thousand kilometres. The squares of larger ones
/// leave no digits for the part.
const LARGEST_HEIGHT: f64 = 1e9;

/// Places on rings from the inner one to the rim.
struct Places {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Places {
    fn on(part: &Part, rings: usize, angles: usize) -> Self {
        let step = (part.aperture_radius - part.inner_radius) / rings as f64;
        let radii = (0..=rings).map(|ring| part.inner_radius + step * ring as f64);
        let turn: Vec<(f64, f64)> = even_angles(angles).map(Scalar::sin_cos).collect();
        let places =
            radii.flat_map(|radius| turn.iter().map(move |(s, c)| (radius * c, radius * s)));
        let (x, y) = places.unzip();
        Self { x, y }
    }
}

/// Refuses a surface that has no height anywhere on the part's inner ring, or one that no part has. A
/// surface without any height on the part is the plugin's fault, not the recipe's.
pub fn check_heights(surface: &Link<dyn SurfaceModel>, part: &Part) -> Result<()> {
    let Places { x, y } = Places::on(part, RINGS, RING_POINTS);
    let mut z = vec![f64::NAN; x.len()];
    let answer = surface.strategy.heights(&x, &y, &mut z);
    answer.map_err(|error| surface.failed("on the part", error))?;
    let place = |at: usize| format!("x = {:.4} mm, y = {:.4} mm", x[at], y[at]);
    if let Some(at) = z
        .iter()
        .position(|z| z.abs() > LARGEST_HEIGHT && z.is_finite())
    {
        return Err(refused(format!(
            "the surface has a height of {:.3e} mm at {}; no part has more than {LARGEST_HEIGHT:e} mm",
            z[at],
            place(at)
        )));
    }
    if z.iter().take(RING_POINTS).any(|z| z.is_finite()) {
        return Ok(());
    }
    if z.iter().any(|z| z.is_finite()) {
        return Err(refused(format!(
            "the surface has no height at {}",
            place(0)
        )));
    }
    let what = format!(
        "no number for z anywhere from radius {} mm to the rim",
        part.inner_radius
    );
    Err(surface.bad_answer(what))
}

/// Refuses a map of which no cell lies on the part: all of the part would be continued.
pub fn check_data(surface: &Link<dyn SurfaceModel>, part: &Part) -> Result<()> {
    let failed = |error| surface.failed("for the distance from its data", error);
    if surface.strategy.data().map_err(failed)?.is_none() {
        return Ok(());
    }
    let Places { x, y } = Places::on(part, MAP_RINGS, MAP_ANGLES);
    let mut distances = vec![0.0; x.len()];
    let answer = surface.strategy.beyond_data(&x, &y, &mut distances);
    answer.map_err(failed)?;
    let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let between = TAU * part.aperture_radius / MAP_ANGLES as f64;
    if least <= between {
        return Ok(());
    }
    Err(refused(format!(
        "the map lies beside the part: the nearest of its points that has a height is {least:.4} mm \
         away; look at its unit, its origin and its decentres"
    )))
}

fn refused(message: String) -> PipelineError {
    PipelineError::NoSurface(StrategyError::failed(message))
}
