//! How X's own error between control points raises the cusps.
//!
//! Playback compares Z at the X that is played, so an error of X alone does not show there: the
//! tool still touches the surface, but at another point. Where two neighbouring passes drift apart,
//! the cusp between them grows with the square of their distance. That matters wherever X moves
//! within the turn: with normal compensation, and with a law that follows the angle.

use std::f64::consts::TAU;

use turnpath_core::hermite::FEED_PART;
use turnpath_core::toolpath::{PathBlock, Segment};
use turnpath_core::{CentreBuffers, Locus, Radial, angle};
use turnpath_verify::cusp_heights;

use crate::aim::NEAR;
use crate::make::BlockPoints;
use crate::plan::Plan;
use crate::{PipelineError, Result, drift_bound};

/// Instants of every segment that show whether its error matters. The error of a cubic with true
/// velocities is largest in the middle. That of velocities with the same error at both ends is zero
/// in the middle, and at a quarter it is within 3 % of its largest value.
const FIRST_INSTANTS: [f64; 3] = [0.25, 0.5, 0.75];
/// The index of the middle among them.
const MIDDLE: usize = 1;
/// How many instants of a segment whose error matters are compared with the cusps there.
const INSTANTS: usize = 16;
/// Part of the distance between passes by which X may always err. Two passes may err in opposite
/// ways, so that a cusp grows by four times this part at the most: by a thousandth, which still
/// counts as held. Samplers aim at four times as much, since most cusps leave room for it.
const ALWAYS: f64 = 0.25 * FEED_PART;
/// Cusps are kept within this part of the residual: halfway to what still counts as held.
const CUSP_AIM: f64 = 1.0005;
/// A cusp that exceeds this part of the residual on the true path comes from the law, and no halving
/// lowers it.
const FROM_LAW: f64 = 1.001;
/// Passes no further apart than this, mm, leave no cusp worth counting: a nanometre. What is measured
/// there is rounding, which turns the line between both centres.
const SAME_POSITION: f64 = 1e-6;

/// X's errors at some instants.
#[derive(Default)]
struct Drifts {
    /// The index of the segment of each instant.
    segment: Vec<usize>,
    /// The instants, in revolutions.
    n: Vec<f64>,
    /// X of the true path, mm.
    x: Vec<f64>,
    /// |played X − X of the true path|, mm.
    error: Vec<f64>,
}

/// For each segment X's error as a part of the error that the residual allows; 0 where the error is
/// far below that.
pub fn loads(plan: &Plan<'_>, block: &BlockPoints) -> Result<Vec<f64>> {
    let points = &block.points;
    let count = points.len().saturating_sub(1);
    let mut loads = vec![0.0; count];
    let instants: [f64; INSTANTS] = std::array::from_fn(|k| (k as f64 + 0.5) / INSTANTS as f64);
    let near = near_the_limit(plan, points)?;
    let drifts = drifts(plan, points, near.into_iter(), &instants)?;
    for side in [-1.0, 1.0] {
        let errors = drifts.segment.iter().zip(&drifts.error);
        for ((segment, error), allowed) in errors.zip(allowed(plan, &drifts, side)?) {
            let load = &mut loads[*segment];
            *load = f64::max(*load, error / allowed);
        }
    }
    Ok(loads)
}

/// The segments whose error is near what is always allowed, or beyond it.
fn near_the_limit(plan: &Plan<'_>, points: &PathBlock) -> Result<Vec<usize>> {
    let undecided = drift_bound::undecided_segments(plan, points, NEAR * ALWAYS);
    let drifts = drifts(plan, points, undecided.iter().copied(), &FIRST_INSTANTS)?;
    let middles = |column: &[f64]| -> Vec<f64> {
        let each = column.iter().skip(MIDDLE).step_by(FIRST_INSTANTS.len());
        each.copied().collect()
    };
    let (n, x) = (middles(&drifts.n), middles(&drifts.x));
    let [before, after] = [-1.0, 1.0].map(|side| neighbours(plan, &n, side));
    let (before, after) = (before?, after?);
    let errors = drifts.error.chunks_exact(FIRST_INSTANTS.len());
    let largest = errors.map(|errors| errors.iter().copied().fold(0.0, f64::max));
    let largest: Vec<f64> = largest.collect();
    let matters = |i: &usize| {
        let to = |other: Option<f64>| other.map_or(f64::INFINITY, |other| (other - x[*i]).abs());
        largest[*i] > NEAR * ALWAYS * to(before[*i]).min(to(after[*i]))
    };
    let numbers = undecided.iter().enumerate();
    let near = numbers.filter(|(i, _)| matters(i));
    Ok(near.map(|(_, number)| *number).collect())
}

/// X's error at these instants of the chosen segments.
fn drifts(
    plan: &Plan<'_>,
    points: &PathBlock,
    chosen: impl ExactSizeIterator<Item = usize>,
    instants: &[f64],
) -> Result<Drifts> {
    let mut drifts = Drifts::default();
    let count = chosen.len() * instants.len();
    drifts.segment.reserve(count);
    drifts.n.reserve(count);
    drifts.error.reserve(count);
    for number in chosen {
        let Some(Segment { c, x, .. }) = points.segment(number) else {
            continue;
        };
        for s in instants {
            drifts.segment.push(number);
            drifts.n.push(c.value(*s) / TAU - plan.start.turns);
            drifts.error.push(x.value(*s));
        }
    }
    drifts.x = true_x(plan, &drifts.n)?;
    for (error, x) in drifts.error.iter_mut().zip(&drifts.x) {
        *error = (*error - x).abs();
    }
    Ok(drifts)
}

/// How large X's error may be at each instant, mm, for the cusp towards the turn before (`side` −1)
/// or after (1).
fn allowed(plan: &Plan<'_>, drifts: &Drifts, side: f64) -> Result<Vec<f64>> {
    let others = neighbours(plan, &drifts.n, side)?;
    let theta: Vec<f64> = drifts.n.iter().map(|n| angle(*n)).collect();
    let pair = |(x, other): (&f64, &Option<f64>)| [*x, other.unwrap_or(*x)];
    let pairs: Vec<[f64; 2]> = drifts.x.iter().zip(&others).map(pair).collect();
    let heights =
        cusp_heights(&plan.preparation.touch, &theta, &pairs).map_err(PipelineError::Measure)?;
    let residual = plan.preparation.task.tolerance.residual;
    let allowed = |(height, [x, other]): (Option<f64>, [f64; 2])| match height {
        Some(height) => allowance(height / residual, (other - x).abs()),
        None => f64::INFINITY,
    };
    Ok(heights.into_iter().zip(pairs).map(allowed).collect())
}

/// The error that a cusp of so many residuals allows passes that are so far apart, mm. The cusp
/// grows with the square of the distance, and both passes may err.
fn allowance(height: f64, apart: f64) -> f64 {
    let matters = apart > SAME_POSITION && height > 0.0 && height <= FROM_LAW;
    if !matters {
        return f64::INFINITY;
    }
    apart * ALWAYS.max(0.5 * ((CUSP_AIM / height).sqrt() - 1.0))
}

/// X of the true path one turn away from each instant, in revolutions; `None` beyond the ends of the path.
fn neighbours(plan: &Plan<'_>, from: &[f64], side: f64) -> Result<Vec<Option<f64>>> {
    let path = 0.0..=plan.law.end();
    let turned = |n: &f64| Some(n + side).filter(|n| path.contains(n));
    let turned: Vec<Option<f64>> = from.iter().map(turned).collect();
    let within: Vec<f64> = turned.iter().copied().flatten().collect();
    let mut x = true_x(plan, &within)?.into_iter();
    let next = |n: Option<f64>| n.and_then(|_| x.next());
    Ok(turned.into_iter().map(next).collect())
}

/// X of the true path at each N, mm.
fn true_x(plan: &Plan<'_>, n: &[f64]) -> Result<Vec<f64>> {
    let rho: Vec<f64> = n.iter().map(|n| plan.law.value(*n)).collect();
    if plan.preparation.locus.radial() == Radial::Centre {
        return Ok(rho);
    }
    let theta: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
    let mut centres = CentreBuffers::default();
    centres.resize(n.len());
    let compensator = &plan.chain.compensator;
    (plan.preparation.locus)
        .centre(&theta, &rho, centres.as_centres())
        .map_err(|error| compensator.failed("while a path was played back", error))?;
    Ok(centres.x)
}
