//! What X's own error between control points does to the cusps.
//!
//! Playback compares Z at the X that is played, so an error of X alone costs nothing there: the
//! tool still touches the surface, but in another place. Where two neighbouring passes err apart
//! the cusp between them grows with the square of their distance. That matters wherever X moves
//! within the turn: with normal compensation, and with a law that follows the angle.

use std::f64::consts::TAU;

use turnpath_core::toolpath::Segment;
use turnpath_core::{CentreBuffers, Locus, Radial, angle};
use turnpath_verify::cusp_heights;

use crate::make::Made;
use crate::plan::Plan;
use crate::refine::NEAR;
use crate::{PipelineError, Result};

/// Where it is seen whether the error matters: the bump of a cubic with true velocities is highest
/// in the middle, that of velocities which err alike at both ends is nought there and within 3 % of
/// its top at a quarter.
const GLANCES: [f64; 3] = [0.25, 0.5, 0.75];
/// Instants of a segment on which it does, at which it is held against the cusps there.
const LOOKS: usize = 16;
/// Part of the distance between passes that X may always err by: what the sampler `atpg` aims at.
/// Two passes may err apart, so that a cusp grows by four times this part at the most.
const ALWAYS: f64 = 1e-4;
/// Cusps are held to this part of the residual: halfway to what still counts as held.
const AIM: f64 = 1.0005;
/// A cusp that is higher than this part of the residual on the true path is the law's matter, and
/// no halving mends it.
const LAWS_OWN: f64 = 1.001;

/// Passes no further apart than this, mm, leave no cusp to speak of: a nanometre. What is measured
/// there is rounding, which turns the line between both centres.
const SAME_PLACE: f64 = 1e-6;

/// X's error at an instant.
struct Drift {
    /// Which segment.
    segment: usize,
    /// When, in revolutions.
    n: f64,
    /// X of the true path, mm.
    x: f64,
    /// Its amount, mm.
    error: f64,
}

/// For each segment X's error over what the residual leaves it; 0 where it is far from that.
pub fn loads(plan: &Plan<'_>, made: &Made) -> Result<Vec<f64>> {
    let segments: Vec<Segment> = made.points.segments().collect();
    let mut loads = vec![0.0; segments.len()];
    let looks = (0..LOOKS).map(|k| (k as f64 + 0.5) / LOOKS as f64);
    let looks: Vec<f64> = looks.collect();
    let drifts = drifts(plan, &segments, &notable(plan, &segments)?, &looks)?;
    for side in [-1.0, 1.0] {
        for (drift, allowed) in drifts.iter().zip(allowed(plan, &drifts, side)?) {
            let load = &mut loads[drift.segment];
            *load = f64::max(*load, drift.error / allowed);
        }
    }
    Ok(loads)
}

/// The segments on which the error is near what always is allowed, or beyond.
fn notable(plan: &Plan<'_>, segments: &[Segment]) -> Result<Vec<usize>> {
    let all: Vec<usize> = (0..segments.len()).collect();
    let drifts = drifts(plan, segments, &all, &GLANCES)?;
    let (mut middles, mut errors) = (Vec::new(), Vec::new());
    for glances in drifts.chunks_exact(GLANCES.len()) {
        middles.extend(glances.get(1));
        errors.push(glances.iter().map(|drift| drift.error).fold(0.0, f64::max));
    }
    let [before, after] = [-1.0, 1.0].map(|side| neighbours(plan, &middles, side));
    let (before, after) = (before?, after?);
    let matters = |i: &usize| {
        let to = |other: Option<f64>| other.map_or(f64::INFINITY, |x| (x - middles[*i].x).abs());
        errors[*i] > NEAR * ALWAYS * to(before[*i]).min(to(after[*i]))
    };
    Ok(all.into_iter().filter(matters).collect())
}

/// X's error at these instants of the chosen segments.
fn drifts(
    plan: &Plan<'_>,
    segments: &[Segment],
    chosen: &[usize],
    instants: &[f64],
) -> Result<Vec<Drift>> {
    let places = chosen.iter().flat_map(|segment| {
        let cubics = &segments[*segment];
        instants.iter().map(move |s| Drift {
            segment: *segment,
            n: cubics.c.value(*s) / TAU - plan.start.turns,
            x: f64::NAN,
            error: cubics.x.value(*s),
        })
    });
    let mut drifts: Vec<Drift> = places.collect();
    let n: Vec<f64> = drifts.iter().map(|drift| drift.n).collect();
    for (drift, x) in drifts.iter_mut().zip(true_x(plan, &n)?) {
        drift.x = x;
        drift.error = (drift.error - x).abs();
    }
    Ok(drifts)
}

/// How far X may be off at each instant, mm, for the cusp towards the turn before (`side` −1) or
/// after (1).
fn allowed(plan: &Plan<'_>, drifts: &[Drift], side: f64) -> Result<Vec<f64>> {
    let every: Vec<&Drift> = drifts.iter().collect();
    let others = neighbours(plan, &every, side)?;
    let theta: Vec<f64> = drifts.iter().map(|drift| angle(drift.n)).collect();
    let pair = |(drift, other): (&Drift, &Option<f64>)| [drift.x, other.unwrap_or(drift.x)];
    let pairs: Vec<[f64; 2]> = drifts.iter().zip(&others).map(pair).collect();
    let heights =
        cusp_heights(&plan.prepared.touch, &theta, &pairs).map_err(PipelineError::Measure)?;
    let residual = plan.prepared.task.tolerance.residual;
    let allowed = |(height, [x, other]): (Option<f64>, [f64; 2])| match height {
        Some(height) => left(height / residual, (other - x).abs()),
        None => f64::INFINITY,
    };
    Ok(heights.into_iter().zip(pairs).map(allowed).collect())
}

/// What a cusp of so many residuals leaves passes that are so far apart, mm: it grows with the
/// square of the distance, and both may err.
fn left(height: f64, apart: f64) -> f64 {
    let matters = apart > SAME_PLACE && height > 0.0 && height <= LAWS_OWN;
    if !matters {
        return f64::INFINITY;
    }
    apart * ALWAYS.max(0.5 * ((AIM / height).sqrt() - 1.0))
}

/// X of the true path one turn off each place; none beyond its ends.
fn neighbours(plan: &Plan<'_>, from: &[&Drift], side: f64) -> Result<Vec<Option<f64>>> {
    let path = 0.0..=plan.law.end();
    let turned = |drift: &&Drift| Some(drift.n + side).filter(|n| path.contains(n));
    let places: Vec<Option<f64>> = from.iter().map(turned).collect();
    let there: Vec<f64> = places.iter().copied().flatten().collect();
    let mut x = true_x(plan, &there)?.into_iter();
    let next = |place: Option<f64>| place.and_then(|_| x.next());
    Ok(places.into_iter().map(next).collect())
}

/// X of the true path at each place, in revolutions.
fn true_x(plan: &Plan<'_>, n: &[f64]) -> Result<Vec<f64>> {
    let rho: Vec<f64> = n.iter().map(|n| plan.law.value(*n)).collect();
    if plan.prepared.locus.radial() == Radial::Centre {
        return Ok(rho);
    }
    let theta: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
    let mut centres = CentreBuffers::default();
    centres.resize(n.len());
    let compensator = &plan.chain.compensator;
    (plan.prepared.locus)
        .centre(&theta, &rho, centres.as_centres())
        .map_err(|error| compensator.failed("while a path was played back", error))?;
    Ok(centres.x)
}
