//! Z of the nose centre where it stands highest on the whole part.

use rayon::prelude::*;
use turnpath_core::{CentreBuffers, Locus, even_angles};

use crate::order::one_at_a_time;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Angles and radii at which the part is scanned. A peak narrower than a degree, or than 1/256 of
/// the radius, can be missed by a part of its own height.
const ANGLES: usize = 360;
const RADII: usize = 256;

/// The largest Z of the nose centre when it touches the part, mm, over all X of the path and the
/// part.
pub fn highest(plan: &Plan<'_>) -> Result<f64> {
    let (inner, outer) = reach(plan)?;
    let theta: Vec<f64> = even_angles(ANGLES).collect();
    let each = one_at_a_time((0..RADII + 1).into_par_iter().map(|i| {
        let x = inner + (outer - inner) * i as f64 / RADII as f64;
        let mut touches = Vec::new();
        let touch = &plan.preparation.touch;
        touch
            .find(&theta, &[x; ANGLES], &mut touches)
            .map_err(PipelineError::Measure)?;
        // Beyond the end of the surface there is no touch: NaN, which `max` ignores.
        Ok(touches.iter().map(|touch| touch.z).fold(f64::NAN, f64::max))
    }))?;
    Ok(each.into_iter().fold(f64::NAN, f64::max))
}

/// The smallest and the largest |X| of the path and the part.
fn reach(plan: &Plan<'_>) -> Result<(f64, f64)> {
    let (task, compensator) = (&plan.preparation.task, &plan.chain.compensator);
    let theta: Vec<f64> = even_angles(ANGLES).collect();
    let (mut inner, mut outer) = (task.part.inner_radius, task.part.aperture_radius);
    for rho in [task.range.inner, task.range.outer] {
        let mut centres = CentreBuffers::default();
        centres.resize(ANGLES);
        let answer = plan
            .preparation
            .locus
            .centre(&theta, &[rho; ANGLES], centres.as_centres());
        answer.map_err(|error| compensator.failed(format!("at ρ = {rho} mm"), error))?;
        for x in centres.x.iter().filter(|x| x.is_finite()) {
            (inner, outer) = (inner.min(x.abs()), outer.max(x.abs()));
        }
    }
    Ok((inner, outer))
}
