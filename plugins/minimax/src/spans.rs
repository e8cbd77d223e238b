//! The parts of a block between which no step may pass.

use turnpath_plugin::hermite::{Bound, pitch};
use turnpath_plugin::prelude::*;

use crate::table::{Limits, jumps, sides};

/// A knot of the law is a border if its jumps alone could take this part of the tolerance on a
/// natural step across it. Steps pass all others: they are judged by their played error.
const BORDER: f64 = 0.5;
/// A knot this close to a border is that border, in revolutions. The sums of the pieces' lengths
/// miss the start of a block by their rounding.
const SAME_POSITION: f64 = 1e-9;

/// The spans of a block, in order.
///
/// # Errors
/// If the path has no value at a knot.
pub fn spans(path: &Path<'_>, block: Revolutions, limits: Limits) -> Result<Vec<Revolutions>> {
    let mut borders = vec![block.start];
    let within = block.start + SAME_POSITION..block.end - SAME_POSITION;
    for n in path.law.knots(block.start, block.end) {
        if within.contains(&n) && is_border(path, n, limits)? {
            borders.push(n);
        }
    }
    borders.push(block.end);
    let span = |pair: &[f64]| Revolutions {
        start: pair[0],
        end: pair[1],
    };
    Ok(borders.windows(2).map(span).collect())
}

fn is_border(path: &Path<'_>, n: f64, limits: Limits) -> Result<bool> {
    let [before, after] = sides(path, n)?;
    let x_weight = limits.allowed / (limits.feed_part * pitch(path, n));
    let fourth = |series: &Series, weight: f64| 24.0 * weight * series[4].abs();
    let of = |before: &Series, after: &Series, weight: f64| {
        let weighted = |series: &Series| series.map(|c| if c == 0.0 { 0.0 } else { c * weight });
        let bound = Bound {
            fourth: fourth(before, weight).max(fourth(after, weight)),
            jumps: jumps(&weighted(before), &weighted(after)),
        };
        let natural = bound.natural_length(limits.allowed);
        let alone = Bound {
            fourth: 0.0,
            ..bound
        };
        alone.error(natural.min(TAU * limits.max_step))
    };
    let largest = of(&before.z, &after.z, 1.0).max(of(&before.x, &after.x, x_weight));
    Ok(largest > BORDER * limits.allowed)
}
