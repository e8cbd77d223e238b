//! Feeds: a law that follows the angle closes by itself at both ends.

use std::f64::consts::TAU;

use turnpath_core::{Continuation, Direction, Setup, SpiralLaw, Task};
use turnpath_pipeline::LARGEST_END_GAP;

use crate::chain::TrialChain;
use crate::fault::FaultKind;

/// Pieces after which a law is taken for one without end. The host has such a limit too.
const MOST_PIECES: usize = 2_000_000;
/// Angles of a turn at which passes are compared.
const ANGLES: usize = 72;
/// The feed of a law that follows the angle differs within a turn by more than this part from what
/// its neighbouring turns have at the same angle on average.
const FOLLOWS: f64 = 0.05;

/// Checks the feed of a chain.
pub fn check(chain: &TrialChain) -> Vec<FaultKind> {
    match law(chain) {
        // The whole path has the same fault, and the host's words for it.
        Err(_) => Vec::new(),
        Ok(law) if law.end() >= 4.0 && follows_angle(&law) => open_ends(&law, chain.task()),
        Ok(_) => Vec::new(),
    }
}

/// The law as the strategy gives it.
fn law(chain: &TrialChain) -> Result<SpiralLaw, FaultKind> {
    let setup = Setup {
        task: chain.task(),
        locus: &chain.preparation.locus,
    };
    let failed = |call| move |error| FaultKind::Call { call, error };
    let plan = chain.chain.feed.strategy.plan(setup);
    let mut plan = plan.map_err(failed("plan"))?;
    let (mut law, mut pieces) = (SpiralLaw::new(), Vec::new());
    loop {
        pieces.clear();
        let onward = plan.extend(setup, &mut pieces).map_err(failed("extend"))?;
        let is_stuck = pieces.is_empty() || law.pieces().len() > MOST_PIECES;
        for piece in &pieces {
            law.push(piece.length, piece.coefficients);
        }
        if onward == Continuation::End || is_stuck {
            return Ok(law);
        }
    }
}

/// The rates at the angles of a turn, less those of a feed that changes evenly over the turn.
fn unevenness(law: &SpiralLaw, turn: f64) -> f64 {
    let (first, last) = (law.rate(turn), law.rate(turn + 1.0));
    let mean = 0.5 * (first.abs() + last.abs());
    let off = |i: usize| {
        let share = i as f64 / ANGLES as f64;
        let even = first + (last - first) * share;
        (law.rate(turn + share) - even).abs() / mean
    };
    (0..ANGLES).map(off).fold(0.0, f64::max)
}

/// Whether the feed changes within the turns of the middle of the law.
fn follows_angle(law: &SpiralLaw) -> bool {
    let turns = law.end().floor();
    let (first, last) = ((0.25 * turns) as u64, (0.75 * turns) as u64);
    let uneven = |turn: &u64| unevenness(law, *turn as f64) > FOLLOWS;
    let count = (first..last).filter(uneven).count() as f64;
    count > 0.5 * (last - first) as f64
}

/// The ends at which a pass lies too far inside of the range's end.
fn open_ends(law: &SpiralLaw, task: &Task) -> Vec<FaultKind> {
    let ends = [("beginning", false), ("end", true)];
    let open = ends.into_iter().filter_map(|(end, last)| {
        let outer = last == (task.direction == Direction::Outward);
        let at = |m: f64| match last {
            true => law.end() - m,
            false => m,
        };
        let passes = (0..ANGLES).map(|i| {
            let m = i as f64 / ANGLES as f64;
            let (rho, next) = (law.value(at(m)), law.value(at(m + 1.0)));
            let inside = match outer {
                true => task.range.outer - rho,
                false => rho - task.range.inner,
            };
            (at(m), inside, LARGEST_END_GAP * (next - rho).abs())
        });
        let worst = passes.max_by(|one, other| (one.1 - one.2).total_cmp(&(other.1 - other.2)));
        let (n, inside, most) = worst.filter(|(_, inside, most)| inside > most)?;
        Some(FaultKind::Open {
            end,
            theta: TAU * n.rem_euclid(1.0),
            inside,
            most,
        })
    });
    open.collect()
}
