//! The closing: the lowest surface that a nose can cut, pass beside pass, where it does not fit.
//!
//! With the nose at X, its lower side stands over the radius s at Z(X) − sqrt(R² − (X − s)²). As X
//! grows, its contact moves outward. The circles of two positions cross once, between their
//! contacts. So if two positions touch inside of s, the outer one stands lower at s; if both touch
//! outside of s, the inner one does. The lowest position is therefore the one whose contact passes
//! s, or jumps over it. For a cusp this position lies between its own two passes, whose contacts
//! lie on either side of it.

use turnpath_core::Result;

use crate::cusp::Point;
use crate::lower_arc::below_centre;
use crate::profiles::Profiles;
use crate::touch::{ANYWHERE, FirstTouch, Touch};

/// Halvings of the distance between two passes. They leave 1e-8 of it, and at most as much in the
/// height.
const HALVINGS: usize = 27;
/// A point within this part of the nose radius from the contact counts as the contact.
const AT_CONTACT: f64 = 1e-4;
/// Cusps that are measured in one batch.
const BATCH: usize = 64;

/// A cusp of one section, and the two passes that leave it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SectionCusp {
    /// Angle of the section, rad.
    pub theta: f64,
    /// The tip of the cusp.
    pub tip: Point,
    /// X of the inner pass, mm.
    pub lower: f64,
    /// X of the outer pass, mm.
    pub upper: f64,
    /// Whether the cusp counts.
    pub counts: bool,
}

/// The height of each cusp above the closing, mm. Only the highest cusps are measured. A cusp whose
/// height above the surface, along z, is no more than another cusp's height above the closing keeps
/// the height above the surface; so does a cusp that does not count.
pub(crate) fn heights(touch: &FirstTouch, cusps: &[SectionCusp]) -> Result<Vec<f64>> {
    let theta: Vec<f64> = cusps.iter().map(|cusp| cusp.theta).collect();
    let rho: Vec<f64> = cusps.iter().map(|cusp| cusp.tip.x).collect();
    let mut profiles = Profiles::new(touch.subject().surface.as_ref(), &theta);
    profiles.at_all(&rho)?;
    let above = cusps.iter().zip(&profiles.height);
    let mut heights: Vec<f64> = above.map(|(cusp, surface)| cusp.tip.y - surface).collect();
    let counts = |i: &usize| cusps[*i].counts && heights[*i].is_finite();
    let mut order: Vec<usize> = (0..cusps.len()).filter(counts).collect();
    order.sort_by(|a, b| heights[*b].total_cmp(&heights[*a]));
    let mut highest = f64::NEG_INFINITY;
    for batch in order.chunks(BATCH) {
        if batch.first().is_none_or(|first| heights[*first] <= highest) {
            break;
        }
        let chosen: Vec<SectionCusp> = batch.iter().map(|i| cusps[*i]).collect();
        for (i, over) in batch.iter().zip(over_closing(touch, &chosen)?) {
            heights[*i] = over;
            highest = highest.max(over);
        }
    }
    Ok(heights)
}

/// The height of each cusp above the closing, mm, along the normal of the nose that leaves the
/// closing there.
fn over_closing(touch: &FirstTouch, cusps: &[SectionCusp]) -> Result<Vec<f64>> {
    let theta: Vec<f64> = cusps.iter().map(|cusp| cusp.theta).collect();
    let rho: Vec<f64> = cusps.iter().map(|cusp| cusp.tip.x).collect();
    let between = cusps.iter().map(|cusp| (cusp.lower, cusp.upper)).collect();
    let lowest = lowest(touch, &theta, &rho, between)?;
    let radius = touch.subject().tool.nose_radius;
    let all = cusps.iter().zip(&lowest);
    Ok(all
        .map(|(cusp, (x, touch))| above_nose(cusp.tip, *x, touch, radius))
        .collect())
}

/// The z of the closing at radii `rho`, mm, and angles `theta`, rad; NaN where the surface has no
/// height. Where the nose comes down to the surface, it is the surface's own height.
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
    let (theta, radii) = (chosen(theta), chosen(rho));
    let between = radii.iter().map(|rho| (rho - reach, rho + reach));
    let lowest = lowest(touch, &theta, &radii, between.collect())?;
    let mut heights = profiles.height;
    for (i, (x, touch)) in rides.iter().zip(lowest) {
        heights[*i] = touch.z - below_centre(radius, rho[*i] - x);
    }
    Ok(heights)
}

/// The X at which the nose stands lowest over each radius, and the touch there: the position
/// `between` two X whose contact passes the radius.
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

fn middles(between: &[(f64, f64)]) -> Vec<f64> {
    between.iter().map(|(a, b)| 0.5 * (a + b)).collect()
}

/// The height of a cusp's tip above the lower side of the nose at X: along the surface's normal at
/// the contact, along the nose's own normal over a seam.
fn above_nose(tip: Point, x: f64, touch: &Touch, radius: f64) -> f64 {
    let lift = below_centre(radius, tip.x - x);
    let height = tip.y - (touch.z - lift);
    if (touch.foot - tip.x).abs() <= AT_CONTACT * radius {
        height / (1.0 + touch.slope * touch.slope).sqrt()
    } else {
        height * lift / radius
    }
}
