//! How much X may err where it moves within the turn: as much as the cusps leave room for.
//!
//! A cusp grows with the square of the distance between its passes, and both may err. So X may err by
//! half the part by which passes lie closer than those whose cusp is the residual. Where a feed holds
//! the residual at every angle, there is next to none, and refinement halves the steps of a sampler
//! that errs all the same.
//!
//! X is that of the nose centre, and so are the distances between passes. A law may count the radius
//! of the contact. In a hollow, contacts lie further apart than centres.

use turnpath_plugin::hermite::{FEED_PART, LEAST_PITCH, pitch};
use turnpath_plugin::prelude::*;

/// The part of the distance between passes by which X may always err: the cusp then grows by a
/// thousandth, which still counts as held.
const ALWAYS: f64 = 0.25 * FEED_PART;
/// Passes that are farther apart than this part of what the residual allows have their cusps from the
/// law, and X's error does not count.
const FROM_LAW: f64 = 1.0005;
/// Every so many places the room is computed. Where cusps are highest, the room between two such
/// places is less than at both, by up to a third with 8 places and by less than a twentieth with 3.
const STRIDE: usize = 3;

/// By how much X may err at each of the places `n`, mm.
///
/// # Errors
/// If the locus has no value or no feed for the residual.
pub fn errors_of_x(path: &Path<'_>, n: &[f64]) -> Result<Vec<f64>> {
    let mut chosen: Vec<f64> = n.iter().copied().step_by(STRIDE).collect();
    chosen.extend(n.last());
    let x = centre_x(path, &chosen)?;
    let mut found = vec![f64::INFINITY; chosen.len()];
    for side in [-1.0, 1.0] {
        include(path, (&chosen, &x), side, &mut found)?;
    }
    for (found, n) in found.iter_mut().zip(&chosen) {
        if found.is_infinite() {
            *found = FEED_PART * pitch(path, *n);
        }
    }
    let least = |k: usize| {
        let first = k / STRIDE;
        found[first].min(found[(first + 1).min(found.len() - 1)])
    };
    Ok((0..n.len()).map(least).collect())
}

/// Lowers the errors to what the cusps between these places and those a turn away allow.
fn include(path: &Path<'_>, (n, x): (&[f64], &[f64]), side: f64, errors: &mut [f64]) -> Result<()> {
    let law = path.law;
    let inside = |n: f64| (0.0..=law.end()).contains(&(n + side));
    let pairs: Vec<usize> = (0..n.len()).filter(|k| inside(n[*k])).collect();
    let other: Vec<f64> = pairs.iter().map(|k| n[*k] + side).collect();
    let theta: Vec<f64> = other.iter().map(|n| angle(*n)).collect();
    let [from, to] = [-side, 0.0].map(|back| other.iter().map(move |n| law.value(n + back)));
    let sides: Vec<(f64, f64)> = from.zip(to).collect();
    let middles: Vec<f64> = sides.iter().map(|(from, to)| 0.5 * (from + to)).collect();
    let mut feed = vec![f64::NAN; pairs.len()];
    let residual = path.task.tolerance.residual;
    let locus = path.locus;
    locus.residual_feed(residual, locus.radial(), &theta, &middles, &mut feed)?;
    let others = centre_x(path, &other)?;
    for (((k, feed), other), (from, to)) in pairs.into_iter().zip(feed).zip(others).zip(sides) {
        let distance = (other - x[k]).abs().max(LEAST_PITCH * feed);
        let error = part((to - from).abs() / feed) * distance;
        errors[k] = errors[k].min(error);
    }
    Ok(())
}

/// The part of their distance by which passes may err that lie so many feeds apart, where one feed
/// leaves the residual.
fn part(feeds: f64) -> f64 {
    match feeds <= FROM_LAW {
        true => (0.5 * (feeds.recip() - 1.0)).clamp(ALWAYS, FEED_PART),
        false => FEED_PART,
    }
}

/// X of the nose centre at each of the places `n`, mm.
fn centre_x(path: &Path<'_>, n: &[f64]) -> Result<Vec<f64>> {
    let rho: Vec<f64> = n.iter().map(|n| path.law.value(*n)).collect();
    if path.locus.radial() == Radial::Centre {
        return Ok(rho);
    }
    let theta: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
    let mut centres = CentreBuffers::default();
    centres.resize(n.len());
    path.locus.centre(&theta, &rho, centres.as_centres())?;
    Ok(centres.x)
}
