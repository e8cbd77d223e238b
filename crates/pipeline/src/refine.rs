//! Refinement: segments whose played error exceeds the tolerance are halved, in global rounds; so
//! are those where X's own error would lift a cusp beyond the residual ([`crate::drift`]).
//!
//! What is kept between rounds is two bytes for each sampler segment (how often it is halved, and
//! what its last playback said), and only blocks that changed, or whose neighbours did, are made
//! again.
//!
//! With a spline, the error of a long segment rises when its neighbour is halved. Where all
//! segments are near the tolerance, halving only those beyond it would move the border between
//! short and long ones by one segment a round. So a halving spreads from a segment that is beyond
//! the tolerance over its neighbours that are near it, four times as far every round.

use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::Dependence;
use turnpath_verify::Meter;

use crate::drift;
use crate::make::{Depths, Made, make};
use crate::order::in_order;
use crate::plan::Plan;
use crate::progress::{Progress, Stage};
use crate::{PipelineError, Result};

/// Part of the tolerance that refinement aims at: what the instants of a playback can miss, and
/// a little for whoever measures again.
pub const AIM: f64 = 0.99;
/// Part of the aim from which on a segment is near it: the spline's error on the long side of a
/// border between steps of 2 : 1 is 1.3 times what it was.
pub const NEAR: f64 = 0.75;
/// Most rounds: a segment ends as 1/4096 of the sampler's at the least.
pub const MOST_ROUNDS: u32 = 12;
/// Rounds before halvings spread: fewer add points to paths that need none of it, more leave
/// long borders no time to move.
const PLAIN_ROUNDS: u32 = 5;
/// Smallest segment that is made, s. Controllers take some 0.4 ms for a servo cycle; a tenth of
/// a millisecond is below what any of them can follow.
pub const SMALLEST_SEGMENT: f64 = 1e-4;
/// Control points of a block above which none of its segments is halved any more: a tolerance
/// that asks for so many (tens of thousands a revolution) is missed, and said to be, before the
/// memory is gone.
const MOST_POINTS: usize = 1_000_000;

/// What the last playback of a sampler segment said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// Far from the aim, or as short as a segment may be.
    Calm,
    /// Near the aim.
    Near,
    /// Beyond the aim.
    Beyond,
    /// Near the aim, and reached by a halving.
    Reached,
}

/// Halves segments until the played error is below the aim everywhere or no segment can be
/// halved any more; gives how often each sampler segment is halved.
pub fn refine(plan: &Plan<'_>, batch: usize, progress: &dyn Progress) -> Result<Vec<Depths>> {
    let dependence = plan.chain.velocity.strategy.dependence();
    let mut depths: Vec<Depths> = vec![Depths::new(); plan.blocks()];
    let mut found: Vec<Vec<Found>> = vec![Vec::new(); plan.blocks()];
    let mut dirty: Vec<usize> = (0..plan.blocks()).collect();
    let mut counts = vec![0; plan.blocks()];
    for round in 1..=MOST_ROUNDS {
        progress.begin(Stage::Refine(round), dirty.len() as u64);
        let mut state = first_state(plan);
        for range in runs(&dirty, batch) {
            let made = make(plan, range.clone(), &depths, state.as_mut())?;
            let looks = in_order(made.par_iter().map(|made| look(plan, made)))?;
            for ((index, look), made) in range.clone().zip(looks).zip(&made) {
                counts[index] = made.owner.len();
                found[index] = look;
            }
            progress.advance(range.len() as u64);
        }
        spread(&mut found, reach(dependence, round));
        let halved = halve(&mut depths, &mut found);
        if halved.is_empty() {
            break;
        }
        dirty = touched(dependence, &counts, halved.into_iter());
    }
    Ok(depths)
}

/// Over how many segments a halving spreads: none where segments do not move their neighbours,
/// and none in the first rounds, in which most paths are done without.
fn reach(dependence: Dependence, round: u32) -> usize {
    match dependence {
        Dependence::Local => 0,
        Dependence::Overlap(_) | Dependence::Sequential => {
            let late = round.saturating_sub(PLAIN_ROUNDS);
            if late > 0 { 4usize.pow(late) } else { 0 }
        }
    }
}

/// Spreads halvings forward and backward along the path, over block borders.
fn spread(found: &mut [Vec<Found>], reach: usize) {
    let mut left = 0;
    for one in found.iter_mut().flatten() {
        left = spread_to(one, left, reach);
    }
    left = 0;
    for one in found
        .iter_mut()
        .rev()
        .flat_map(|block| block.iter_mut().rev())
    {
        left = spread_to(one, left, reach);
    }
}

/// How far the halving still spreads behind this segment.
fn spread_to(one: &mut Found, left: usize, reach: usize) -> usize {
    match *one {
        Found::Beyond => reach,
        Found::Near | Found::Reached if left > 0 => {
            *one = Found::Reached;
            left - 1
        }
        _ => 0,
    }
}

/// Halves what is beyond the aim or reached; gives the blocks that changed.
fn halve(depths: &mut [Depths], found: &mut [Vec<Found>]) -> Vec<usize> {
    let mut changed = Vec::new();
    for (index, (depths, found)) in depths.iter_mut().zip(found).enumerate() {
        let chosen = |one: &Found| matches!(one, Found::Beyond | Found::Reached);
        if !found.iter().any(chosen) {
            continue;
        }
        changed.push(index);
        depths.resize(found.len(), 0);
        for (depth, one) in depths.iter_mut().zip(found.iter_mut()) {
            *depth += u8::from(chosen(one));
            *one = Found::Calm;
        }
    }
    changed
}

/// The state that a sequential solver starts with; nothing for others.
pub fn first_state(plan: &Plan<'_>) -> Option<Vec<f64>> {
    let sequential = plan.chain.velocity.strategy.dependence() == Dependence::Sequential;
    sequential.then(Vec::new)
}

/// Plays a block back and says how each of its sampler segments is.
fn look(plan: &Plan<'_>, made: &Made) -> Result<Vec<Found>> {
    let segments = made.owner.last().map_or(0, |last| *last as usize + 1);
    let mut found = vec![Found::Calm; segments];
    if made.points.len() > MOST_POINTS {
        return Ok(found);
    }
    let touch = &plan.prepared.touch;
    let errors = Meter::segment_errors(touch, &made.points).map_err(PipelineError::Measure)?;
    let aim = AIM * plan.prepared.task.tolerance.interpolation;
    let drifts = drift::loads(plan, made)?;
    let loads = errors
        .iter()
        .zip(drifts)
        .map(|(error, drift)| drift.max(error / aim));
    let times = made.points.t.windows(2);
    for ((load, owner), time) in loads.zip(&made.owner).zip(times) {
        let one = &mut found[*owner as usize];
        let long_enough = time[1] - time[0] >= 2.0 * SMALLEST_SEGMENT;
        if long_enough && load > 1.0 {
            *one = Found::Beyond;
        } else if long_enough && load > NEAR && *one == Found::Calm {
            *one = Found::Near;
        }
    }
    Ok(found)
}

/// The blocks that change when these do; `counts` has the nodes of each block.
fn touched(
    dependence: Dependence,
    counts: &[usize],
    halved: impl Iterator<Item = usize>,
) -> Vec<usize> {
    let mut touched = vec![false; counts.len()];
    for index in halved {
        let range = match dependence {
            Dependence::Sequential => 0..counts.len(),
            // The last segment of the block before ends at this block's first node, which stays.
            Dependence::Local => index..index + 1,
            Dependence::Overlap(overlap) => within_overlap(overlap, counts, index),
        };
        touched[range].fill(true);
    }
    (0..counts.len()).filter(|index| touched[*index]).collect()
}

/// The blocks that see some node of block `index` among `overlap` ones of their neighbours.
fn within_overlap(overlap: usize, counts: &[usize], index: usize) -> Range<usize> {
    let (mut first, mut last) = (index, index + 1);
    let (mut before, mut after) = (0, 0);
    while first > 0 && before <= overlap {
        first -= 1;
        before += counts[first];
    }
    while last < counts.len() && after <= overlap {
        after += counts[last];
        last += 1;
    }
    first..last
}

/// Blocks in a row, at most `batch` at a time.
pub fn runs(blocks: &[usize], batch: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for index in blocks {
        match runs.last_mut() {
            Some(run) if run.end == *index && run.len() < batch => run.end += 1,
            _ => runs.push(*index..*index + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_blocks_do_not_hide_what_lies_behind_them() {
        let touched = |dependence, counts: &[usize], index: usize| {
            touched(dependence, counts, std::iter::once(index))
        };
        let overlap = Dependence::Overlap(64);
        assert_eq!(touched(overlap, &[500; 5], 2), [1, 2, 3]);
        assert_eq!(touched(overlap, &[500, 500, 40, 500, 1], 3), [1, 2, 3, 4]);
        assert_eq!(touched(Dependence::Local, &[500; 3], 1), [1]);
        assert_eq!(touched(Dependence::Sequential, &[500; 3], 2), [0, 1, 2]);
    }

    #[test]
    fn a_halving_spreads_over_neighbours_that_are_near_the_aim() {
        use Found::{Beyond, Calm, Near, Reached};
        let mut found = vec![vec![Near, Calm, Near, Near], vec![Near, Beyond, Near, Calm]];
        spread(&mut found, 2);
        assert_eq!(found[0], [Near, Calm, Near, Reached]);
        assert_eq!(found[1], [Reached, Beyond, Reached, Calm]);
        let mut depths = vec![Depths::new(); 2];
        assert_eq!(halve(&mut depths, &mut found), [0, 1]);
        assert_eq!(depths, [vec![0, 0, 0, 1], vec![1, 1, 1, 0]]);
    }

    #[test]
    fn runs_are_rows_of_at_most_a_batch() {
        assert_eq!(runs(&[0, 1, 2, 5, 6, 9], 2), [0..2, 2..3, 5..7, 9..10]);
        assert!(runs(&[], 4).is_empty());
    }
}
