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
use crate::touch::{FirstTouch, Touch};

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
    let mut between: Vec<(f64, f64)> = cusps.iter().map(|cusp| (cusp.lower, cusp.upper)).collect();
    let mut touches = Vec::new();
    for _ in 0..HALVINGS {
        let middle = middles(&between);
        touch.find(&theta, &middle, &mut touches)?;
        let halves = between.iter_mut().zip(&touches).zip(cusps).zip(middle);
        for (((between, touch), cusp), middle) in halves {
            if touch.foot < cusp.place.x {
                between.0 = middle;
            } else {
                between.1 = middle;
            }
        }
    }
    let middle = middles(&between);
    touch.find(&theta, &middle, &mut touches)?;
    let radius = touch.subject().tool.nose_radius;
    let all = cusps.iter().zip(&touches).zip(&middle);
    Ok(all
        .map(|((cusp, touch), x)| above_nose(cusp.place, *x, touch, radius))
        .collect())
}

fn middles(between: &[(f64, f64)]) -> Vec<f64> {
    between.iter().map(|(a, b)| 0.5 * (a + b)).collect()
}

/// How far a place stands above the lower side of the nose that touches at X: along the surface's
/// normal where the contact is, along the nose's own over a seam.
fn above_nose(place: Point, x: f64, touch: &Touch, radius: f64) -> f64 {
    let offset = place.x - x;
    let lift = (radius * radius - offset * offset).max(0.0).sqrt();
    let height = place.y - (touch.z - lift);
    if (touch.foot - place.x).abs() <= AT_CONTACT * radius {
        height / (1.0 + touch.slope * touch.slope).sqrt()
    } else {
        height * lift / radius
    }
}
