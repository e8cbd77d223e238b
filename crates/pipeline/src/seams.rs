//! Feeds over seams that the nose rides over. Where a law would leave more than the residual there,
//! its strategy is asked for a smaller residual.
//!
//! A feed that holds the residual of a smooth part follows from the curvature at the contact. Over
//! a seam the curvature does not suffice: the nose goes down one flank and up the other, and two
//! passes a feed f apart leave a cusp of Δf/4 + f²/8R between them, where Δ is the corner of the
//! nose's height. No strategy knows the corners, but every strategy can be asked for a smaller
//! residual: feeds go with its root.

use std::f64::consts::TAU;

use turnpath_core::{Direction, SpiralLaw, Task};
use turnpath_verify::{Ride, rides};

use crate::observer::Observer;
use crate::prepare::Preparation;
use crate::{Chain, PipelineError, Result, law};

/// How often a law is planned again at the most. Where the feed is the same everywhere, once is
/// enough.
const ROUNDS: usize = 6;
/// Part of the largest feed that the law aims at. Corners between the examined sections are a little
/// sharper.
const AIM: f64 = 0.97;
/// Part of the largest feed that counts as held.
const ENOUGH: f64 = 0.98;
/// A law that is asked for a smaller residual must become longer by this factor. If it does not, its
/// feed does not depend on the residual: the recipe sets it.
const RESPONSE: f64 = 1.02;

/// The law of the chain's feed strategy, with cusps beside seams within the residual as far as the
/// strategy can plan it so.
pub fn plan(
    chain: &Chain,
    preparation: &Preparation,
    observer: &dyn Observer,
) -> Result<SpiralLaw> {
    let task = &preparation.task;
    let first = law::plan(chain, task, &preparation.locus, observer)?;
    let rides = rides(&preparation.touch, task.range.outer).map_err(PipelineError::Measure)?;
    let mut stricter = task.clone();
    let mut over = over_feed(&first, task, &rides);
    let (mut best, mut least, mut turns) = (first, over, 0.0);
    for _ in 0..ROUNDS {
        if over <= ENOUGH {
            break;
        }
        stricter.tolerance.residual *= AIM * AIM / (over * over);
        let candidate = match law::plan(chain, &stricter, &preparation.locus, observer) {
            Ok(candidate) => candidate,
            Err(PipelineError::Cancelled) => return Err(PipelineError::Cancelled),
            // No law holds so small a residual: the best so far is measured as it is.
            Err(_) => break,
        };
        over = over_feed(&candidate, task, &rides);
        let responds = candidate.end() > RESPONSE * best.end().max(turns);
        turns = candidate.end();
        if over < least {
            (best, least) = (candidate, over);
        }
        if !responds {
            break;
        }
    }
    Ok(best)
}

/// A law's feed over the worst ride, as a multiple of the largest feed that holds the residual there.
fn over_feed(law: &SpiralLaw, task: &Task, rides: &[Ride]) -> f64 {
    let (radius, residual) = (task.tool.nose_radius, task.tolerance.residual);
    let over = |ride: &Ride| {
        let corner = ride.corner;
        let most = radius * ((corner * corner + 8.0 * residual / radius).sqrt() - corner);
        feed_at(law, task.direction, ride) / most
    };
    rides.iter().map(over).fold(0.0, f64::max)
}

/// The distance from the last pass before a ride to the first pass after it. Beyond the ends of the
/// law it is the distance of the first or the last turn. Passes at one angle are whole turns apart.
fn feed_at(law: &SpiralLaw, direction: Direction, ride: &Ride) -> f64 {
    let across = if ride.x < 0.0 { 0.5 } else { 0.0 };
    let begin = (ride.theta / TAU + across).rem_euclid(1.0);
    let before = |turn: u64| match direction {
        Direction::Outward => law.value(begin + turn as f64) < ride.x.abs(),
        Direction::Inward => law.value(begin + turn as f64) > ride.x.abs(),
    };
    let whole = (law.end() - begin).floor();
    if whole < 1.0 {
        return (law.value(law.end()) - law.value(0.0)).abs();
    }
    let (mut low, mut high) = (0, whole as u64);
    while high - low > 1 {
        let middle = low.midpoint(high);
        match before(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    (law.value(begin + high as f64) - law.value(begin + low as f64)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ride(x: f64, theta: f64) -> Ride {
        let corner = 0.1;
        Ride { x, theta, corner }
    }

    #[test]
    fn the_feed_around_a_radius_is_that_of_its_turn() {
        let mut law = SpiralLaw::new();
        law.push(10.0, [1.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
        law.push(10.0, [2.0, 0.2, 0.0, 0.0, 0.0, 0.0]);
        let feed = |x, theta| feed_at(&law, Direction::Outward, &ride(x, theta));
        assert!((feed(1.5, 1.0) - 0.1).abs() < 1e-12);
        assert!((feed(3.0, 1.0) - 0.2).abs() < 1e-12);
        // Half a turn beyond the knot, on either side of the axis.
        assert!((feed(2.0, 0.5 * TAU) - 0.15).abs() < 1e-12);
        assert!((feed(-2.0, 0.0) - 0.15).abs() < 1e-12);
        // Beyond the ends of the law: the feed of the first and of the last turn.
        assert!((feed(0.0, 0.0) - 0.1).abs() < 1e-12);
        assert!((feed(9.0, 0.0) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_law_inward_has_its_feed_and_less_than_a_turn_is_one_feed() {
        let mut law = SpiralLaw::new();
        law.push(10.0, [2.0, -0.1, 0.0, 0.0, 0.0, 0.0]);
        let feed = feed_at(&law, Direction::Inward, &ride(1.234, 2.0));
        assert!((feed - 0.1).abs() < 1e-12);
        let mut law = SpiralLaw::new();
        law.push(0.5, [2.0, -0.1, 0.0, 0.0, 0.0, 0.0]);
        let feed = feed_at(&law, Direction::Inward, &ride(1.99, 2.0));
        assert!((feed - 0.05).abs() < 1e-12);
    }

    /// Each turn goes out on its first half and a little back on its second.
    #[test]
    fn a_law_that_follows_the_angle_has_the_feed_of_the_angle() {
        let mut law = SpiralLaw::new();
        let mut rho = 0.0;
        for turn in 0..20 {
            for half in [0.1 + 0.01 * f64::from(turn), -0.02] {
                law.push(0.5, [rho, 2.0 * half, 0.0, 0.0, 0.0, 0.0]);
                rho += half;
            }
        }
        let feed = |x, theta| feed_at(&law, Direction::Outward, &ride(x, theta));
        for turn in 2..15 {
            let x = law.value(f64::from(turn) + 0.5) + 1e-6;
            let known = law.value(f64::from(turn) + 1.5) - law.value(f64::from(turn) + 0.5);
            assert!((feed(x, 0.5 * TAU) - known).abs() < 1e-12);
        }
    }
}
