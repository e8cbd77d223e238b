//! The closing: what a nose can cut at best, pass beside pass, where it does not fit.
//!
//! With the nose at X its lower side stands over the place s at Z(X) − sqrt(R² − (X − s)²). As X
//! grows, its contact moves outward. Of two positions that touch inside of s the outer one stands
//! lower there, of two that touch outside of it the inner one: their circles cross between their
//! contacts, once. So the lowest is where the contact passes s, or jumps over it. For a cusp that
//! is between its own two passes, whose contacts lie on either side of it.

use turnpath_core::Result;

use crate::cusp::Point;
use crate::profiles::Profiles;
use crate::touch::{ANYWHERE, FirstTouch, Touch};

/// Halvings of the distance of two passes: 1e-8 of it, and in the height at most as much.
const HALVINGS: usize = 27;
/// A place this part of the nose radius from the contact is at the contact.
const AT_CONTACT: f64 = 1e-4;
/// Cusps that are looked at in one batch.
const BATCH: usize = 64;

/// A cusp between two passes at X = `lower` and X = `upper`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raised {
    /// Angle of its section, rad.
    pub theta: f64,
    /// Its tip.
    pub place: Point,
    /// The inner pass.
    pub lower: f64,
    /// The outer pass.
    pub upper: f64,
    /// Whether it is one that counts.
    pub counts: bool,
}

/// How far each cusp stands above the closing. Only the highest are looked at: where the height
/// above the surface, along z, is no more than what another cusp stands above the closing, it is
/// given in its place. Cusps that do not count are left as they are above the surface.
pub(crate) fn heights(touch: &FirstTouch, cusps: &[Raised]) -> Result<Vec<f64>> {
    let theta: Vec<f64> = cusps.iter().map(|cusp| cusp.theta).collect();
    let rho: Vec<f64> = cusps.iter().map(|cusp| cusp.place.x).collect();
    let mut profiles = Profiles::new(touch.subject().surface.as_ref(), &theta);
    profiles.at_all(&rho)?;
    let above = cusps.iter().zip(&profiles.height);
    let mut heights: Vec<f64> = above
        .map(|(cusp, surface)| cusp.place.y - surface)
        .collect();
    let counts = |i: &usize| cusps[*i].counts && heights[*i].is_finite();
    let mut order: Vec<usize> = (0..cusps.len()).filter(counts).collect();
    order.sort_by(|a, b| heights[*b].total_cmp(&heights[*a]));
    let mut highest = f64::NEG_INFINITY;
    for batch in order.chunks(BATCH) {
        if batch.first().is_none_or(|first| heights[*first] <= highest) {
            break;
        }
        let chosen: Vec<Raised> = batch.iter().map(|i| cusps[*i]).collect();
        for (i, over) in batch.iter().zip(over_closing(touch, &chosen)?) {
            heights[*i] = over;
            highest = highest.max(over);
        }
    }
    Ok(heights)
}

/// How far each cusp stands above the closing, along the normal of the nose that leaves it.
fn over_closing(touch: &FirstTouch, cusps: &[Raised]) -> Result<Vec<f64>> {
    let theta: Vec<f64> = cusps.iter().map(|cusp| cusp.theta).collect();
    let rho: Vec<f64> = cusps.iter().map(|cusp| cusp.place.x).collect();
    let between = cusps.iter().map(|cusp| (cusp.lower, cusp.upper)).collect();
    let lowest = lowest(touch, &theta, &rho, between)?;
    let radius = touch.subject().tool.nose_radius;
    let all = cusps.iter().zip(&lowest);
    Ok(all
        .map(|(cusp, (x, touch))| above_nose(cusp.place, *x, touch, radius))
        .collect())
}

/// The heights along z of the closing at radii `rho` and angles `theta`; no number where the surface
/// has none. Where the nose comes down to the surface, that is the surface's own.
pub(crate) fn at(touch: &FirstTouch, theta: &[f64], rho: &[f64]) -> Result<Vec<f64>> {
    let tool = touch.subject().tool;
    let (radius, reach) = (tool.nose_radius, tool.reach());
    let mut profiles = Profiles::new(touch.subject().surface.as_ref(), theta);
    profiles.at_all(rho)?;
    let along_normal = rho.iter().zip(&profiles.slope).map(|(rho, slope)| {
        let offset = radius * slope / (1.0 + slope * slope).sqrt();
        rho - offset.clamp(-reach, reach)
    });
    let along_normal: Vec<f64> = along_normal.collect();
    let mut touches = Vec::new();
    touch.find(theta, &along_normal, &mut touches)?;
    let rides = |i: &usize| (touches[*i].foot - rho[*i]).abs() > AT_CONTACT * radius;
    let rides: Vec<usize> = (0..rho.len()).filter(rides).collect();
    let chosen = |all: &[f64]| -> Vec<f64> { rides.iter().map(|i| all[*i]).collect() };
    let (theta, places) = (chosen(theta), chosen(rho));
    let between = places.iter().map(|rho| (rho - reach, rho + reach));
    let lowest = lowest(touch, &theta, &places, between.collect())?;
    let mut heights = profiles.height;
    for (i, (x, touch)) in rides.iter().zip(lowest) {
        heights[*i] = touch.z - lift(radius, rho[*i] - x);
    }
    Ok(heights)
}

/// The position of the nose that stands lowest over each place, and its touch: the one of those
/// `between` two X whose contact passes the place.
fn lowest(
    touch: &FirstTouch,
    theta: &[f64],
    rho: &[f64],
    mut between: Vec<(f64, f64)>,
) -> Result<Vec<(f64, Touch)>> {
    let mut touches = Vec::new();
    let mut feet = vec![ANYWHERE; rho.len()];
    for _ in 0..HALVINGS {
        let middle = middles(&between);
        touch.find_within(theta, &middle, |i| feet[i], &mut touches)?;
        for (i, (touch, middle)) in touches.iter().zip(middle).enumerate() {
            if touch.foot < rho[i] {
                (between[i].0, feet[i].0) = (middle, touch.foot);
            } else {
                (between[i].1, feet[i].1) = (middle, touch.foot);
            }
        }
    }
    let middle = middles(&between);
    touch.find_within(theta, &middle, |i| feet[i], &mut touches)?;
    Ok(middle.into_iter().zip(touches).collect())
}

/// How far the centre of the nose stands above its lower side at an offset.
fn lift(radius: f64, offset: f64) -> f64 {
    (radius * radius - offset * offset).max(0.0).sqrt()
}

fn middles(between: &[(f64, f64)]) -> Vec<f64> {
    between.iter().map(|(a, b)| 0.5 * (a + b)).collect()
}

/// How far a place stands above the lower side of the nose that touches at X: along the surface's
/// normal where the contact is, along the nose's own over a seam.
fn above_nose(place: Point, x: f64, touch: &Touch, radius: f64) -> f64 {
    let lift = lift(radius, place.x - x);
    let height = place.y - (touch.z - lift);
    if (touch.foot - place.x).abs() <= AT_CONTACT * radius {
        height / (1.0 + touch.slope * touch.slope).sqrt()
    } else {
        height * lift / radius
    }
}
