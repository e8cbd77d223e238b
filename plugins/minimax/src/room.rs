//! How much X may err where it moves within the turn: as much as the cusps leave room for.
//!
//! A cusp grows with the square of the distance between its passes, and both may err. So X may err by
//! half the part by which passes lie closer than those whose cusp is the residual. Where a feed holds
//! the residual at every angle, there is next to none, and refinement halves the steps of a sampler
//! that errs all the same.

use turnpath_plugin::hermite::FEED_PART;
use turnpath_plugin::prelude::*;

/// The part of the distance between passes by which X may always err: the cusp then grows by a
/// thousandth, which still counts as held.
const ALWAYS: f64 = 0.25 * FEED_PART;
/// Passes that are farther apart than this part of what the residual allows have their cusps from the
/// law, and X's error does not count.
const FROM_LAW: f64 = 1.0005;
/// Every so many places the room is computed. Steps have at least three times as many places.
const STRIDE: usize = 8;

/// The part of the distance between passes by which X may err, at each of the places `n`.
///
/// # Errors
/// If the locus has no feed for the residual.
pub fn parts(path: &Path<'_>, n: &[f64]) -> Result<Vec<f64>> {
    let mut chosen: Vec<f64> = n.iter().copied().step_by(STRIDE).collect();
    chosen.extend(n.last());
    let mut found = vec![FEED_PART; chosen.len()];
    for side in [-1.0, 1.0] {
        include(path, &chosen, side, &mut found)?;
    }
    let least = |k: usize| {
        let first = k / STRIDE;
        found[first].min(found[(first + 1).min(found.len() - 1)])
    };
    Ok((0..n.len()).map(least).collect())
}

/// Lowers the parts to what the cusps between these places and those a turn away allow.
fn include(path: &Path<'_>, n: &[f64], side: f64, parts: &mut [f64]) -> Result<()> {
    let law = path.law;
    let rho = |n: f64| law.value(n);
    let inside = |n: f64| (0.0..=law.end()).contains(&(n + side));
    let pairs: Vec<usize> = (0..n.len()).filter(|k| inside(n[*k])).collect();
    let theta: Vec<f64> = pairs.iter().map(|k| angle(n[*k])).collect();
    let middle = |k: &usize| 0.5 * (rho(n[*k]) + rho(n[*k] + side));
    let middles: Vec<f64> = pairs.iter().map(middle).collect();
    let mut feed = vec![f64::NAN; pairs.len()];
    let residual = path.task.tolerance.residual;
    let locus = path.locus;
    locus.residual_feed(residual, locus.radial(), &theta, &middles, &mut feed)?;
    for (k, feed) in pairs.into_iter().zip(feed) {
        let apart = (rho(n[k] + side) - rho(n[k])).abs();
        if apart <= FROM_LAW * feed {
            let part = 0.5 * (feed / apart - 1.0);
            parts[k] = parts[k].min(part.max(ALWAYS));
        }
    }
    Ok(())
}
