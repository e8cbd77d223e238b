//! Feeds over seams that the nose rides over: a strategy is asked for a smaller residual where its law
//! would leave more.
//!
//! A feed that holds the residual of a smooth part asks how sharply the part bends at the contact.
//! Over a seam that does not say it: there the nose goes down one flank and up the other, and two
//! passes a feed f apart leave a cusp of Δf/4 + f²/8R between them, Δ the corner of its height. No
//! strategy knows of that, but all can be asked for less: feeds go with the root of the residual.

use turnpath_core::{Direction, Job, SpiralLaw};
use turnpath_verify::{Ride, rides};

use crate::prepare::Prepared;
use crate::{Chain, PipelineError, Result, law};

/// How often a law is planned anew at the most: where the feed is everywhere the same, once is
/// enough.
const ROUNDS: usize = 6;
/// Part of the largest feed that is aimed at: corners between the sections that were looked at are
/// a little sharper.
const AIM: f64 = 0.97;
/// Part of it that is taken for held.
const ENOUGH: f64 = 0.98;
/// A law that is asked for less must become longer by this factor, or it does not listen: its feed is
/// the recipe's own.
const LISTENS: f64 = 1.02;
/// Halvings in the search for a radius: down to rounding.
const HALVINGS: usize = 60;

/// The law of the chain's feed, with cusps beside seams within the residual as far as it can be had.
pub fn plan(chain: &Chain, prepared: &Prepared) -> Result<SpiralLaw> {
    let first = law::plan(chain, &prepared.job, &prepared.locus)?;
    let rides = rides(&prepared.touch).map_err(PipelineError::Measure)?;
    let job = &prepared.job;
    let mut asked = job.clone();
    let mut over = over_feed(&first, job, &rides);
    let (mut best, mut least, mut turns) = (first, over, 0.0);
    for _ in 0..ROUNDS {
        if over <= ENOUGH {
            break;
        }
        asked.tolerance.residual *= AIM * AIM / (over * over);
        let tried = law::plan(chain, &asked, &prepared.locus)?;
        over = over_feed(&tried, job, &rides);
        let listens = tried.end() > LISTENS * best.end().max(turns);
        turns = tried.end();
        if over < least {
            (best, least) = (tried, over);
        }
        if !listens {
            break;
        }
    }
    Ok(best)
}

/// How many times as large as it may be a law's feed is over the worst ride.
fn over_feed(law: &SpiralLaw, job: &Job, rides: &[Ride]) -> f64 {
    let (radius, residual) = (job.tool.nose_radius, job.tolerance.residual);
    let over = |ride: &Ride| {
        let corner = ride.corner;
        let most = radius * ((corner * corner + 8.0 * residual / radius).sqrt() - corner);
        feed_at(law, job.direction, ride.x.abs()) / most
    };
    rides.iter().map(over).fold(0.0, f64::max)
}

/// The way of the turn around the place where the law comes to `rho`.
fn feed_at(law: &SpiralLaw, direction: Direction, rho: f64) -> f64 {
    let before = |n: f64| match direction {
        Direction::Outward => law.value(n) < rho,
        Direction::Inward => law.value(n) > rho,
    };
    let (mut low, mut high) = (0.0, law.end());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match before(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    let from = (low - 0.5).clamp(0.0, (law.end() - 1.0).max(0.0));
    (law.value((from + 1.0).min(law.end())) - law.value(from)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_feed_around_a_radius_is_that_of_its_turn() {
        let mut law = SpiralLaw::new();
        law.push(10.0, [1.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
        law.push(10.0, [2.0, 0.2, 0.0, 0.0, 0.0, 0.0]);
        let feed = |rho| feed_at(&law, Direction::Outward, rho);
        assert!((feed(1.5) - 0.1).abs() < 1e-12);
        assert!((feed(3.0) - 0.2).abs() < 1e-12);
        assert!((feed(2.0) - 0.15).abs() < 1e-12);
        // Beyond its ends, that of the first and the last turn.
        assert!((feed(0.0) - 0.1).abs() < 1e-12 && (feed(9.0) - 0.2).abs() < 1e-12);
    }
}
