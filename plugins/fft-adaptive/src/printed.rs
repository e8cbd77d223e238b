//! The step as eq. 4 prints it: from the curvature at its start alone, z = f(r_j, l), l = r_j θ.

use turnpath_plugin::hermite::SHORTEST;
use turnpath_plugin::prelude::*;

use crate::revolution::{no_bend, too_short};
use crate::rule::{Bend, Rule};

/// Δθ from `n`, rad, on the circle of ρ = r_j through the start. This circle is the printed curve;
/// the spiral leaves it by the feed.
///
/// # Errors
/// If the circle has no curvature at the start, or a curvature that needs steps below the shortest.
pub fn step_from(path: &Path<'_>, turn: Turn, n: f64, rule: &Rule) -> Result<f64> {
    let rho = path.radius_at(n);
    let theta = [TAU * (n - n.floor()), 1.0, 0.0, 0.0, 0.0];
    let (mut x, mut z) = ([[f64::NAN; 5]], [[f64::NAN; 5]]);
    let centre = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    let circle = [rho, 0.0, 0.0, 0.0, 0.0];
    path.locus.series(&[theta], &[circle], centre)?;
    let [x] = x;
    let [z] = z;
    let step = rule.step(Bend::of(&x, &z));
    let step = step.ok_or_else(|| no_bend(n, rho))?;
    if step < SHORTEST {
        return Err(too_short(path, turn, step));
    }
    Ok(step)
}
