//! Refinement halves, in global rounds, the segments whose played error exceeds the tolerance. It
//! also halves those where X's own error would raise a cusp beyond the residual ([`crate::drift`]).
//!
//! Refinement keeps two bytes for each sampler segment between rounds: how often the segment is
//! halved, and its state after the last playback. Only blocks that changed, or whose neighbours
//! did, are made again.
//!
//! With a spline, the error of a long segment rises when its neighbour is halved. Where all
//! segments are near the tolerance, halving only those beyond it would move the border between
//! short and long segments by one segment a round. So a halving spreads from a segment that is
//! beyond the tolerance over its neighbours that are near it, four times as far every round. It
//! passes over a calm segment between them.

use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::Dependence;
use turnpath_verify::Meter;

use crate::aim::{AIM, NEAR};
use crate::drift;
use crate::make::{BlockPoints, Depths, first_state, make};
use crate::observer::{Observer, Stage, stop_if_cancelled};
use crate::order::in_order;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Most rounds. A segment ends as 1/4096 of the sampler's at the least.
pub const MOST_ROUNDS: u32 = 12;
/// Rounds before halvings spread. Fewer would add points to paths that need no spreading; more would
/// leave too few rounds for long borders to move.
const PLAIN_ROUNDS: u32 = 5;
/// Over how many calm segments in a row a halving spreads. Where the rounds before halved every second
/// segment, each long one lies between two that are calm, and its error still rises by some hundredths
/// when the next long one is halved. Over more calm segments the rise is some thousandths, and
/// halvings would go far over paths that need none.
const GAP: usize = 1;
/// Smallest segment that refinement makes, s. Controllers take some 0.4 ms for a servo cycle; none
/// can follow a tenth of a millisecond.
pub const SMALLEST_SEGMENT: f64 = 1e-4;
/// Control points of a block above which none of its segments is halved any more. A tolerance that
/// needs so many (tens of thousands a revolution) is missed and reported as missed, before memory
/// runs out.
const MOST_POINTS: usize = 1_000_000;

/// The state of a sampler segment after its last playback.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SegmentState {
    /// Far from the aim, or as short as a segment may be.
    Calm,
    /// Near the aim.
    Near,
    /// Beyond the aim.
    Beyond,
    /// Near the aim, and a halving has spread to it.
    Reached,
}

/// Halves segments until the played error is below the aim everywhere, or no segment can be halved
/// any more. Gives how often each sampler segment is halved. Only the `chosen` blocks are refined, in
/// their order; of the others nothing is halved.
pub fn refine(
    plan: &Plan<'_>,
    batch: usize,
    chosen: &[usize],
    observer: &dyn Observer,
) -> Result<Vec<Depths>> {
    let dependence = plan.chain.velocity.strategy.dependence();
    let mut depths: Vec<Depths> = vec![Depths::new(); plan.blocks()];
    let mut states: Vec<Vec<SegmentState>> = vec![Vec::new(); plan.blocks()];
    let mut dirty: Vec<usize> = chosen.to_vec();
    let mut counts = vec![0; plan.blocks()];
    for round in 1..=MOST_ROUNDS {
        observer.begin(Stage::Refine(round), dirty.len() as u64);
        let mut solver_state = first_state(plan);
        for range in runs(&dirty, batch) {
            stop_if_cancelled(observer)?;
            let blocks = make(plan, range.clone(), &depths, solver_state.as_mut())?;
            let played = in_order(blocks.par_iter().map(|block| play(plan, block)))?;
            for ((index, played), block) in range.clone().zip(played).zip(&blocks) {
                counts[index] = block.owner.len();
                states[index] = played;
            }
            observer.advance(range.len() as u64);
        }
        spread(&mut states, reach(dependence, round));
        let halved = halve(&mut depths, &mut states);
        if halved.is_empty() {
            break;
        }
        dirty = affected(dependence, &counts, halved.into_iter());
        dirty.retain(|index| chosen.binary_search(index).is_ok());
    }
    Ok(depths)
}

/// Over how many segments a halving spreads. It spreads over none where segments do not move their
/// neighbours, and over none in the first rounds, which suffice for most paths.
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
fn spread(states: &mut [Vec<SegmentState>], reach: usize) {
    let mut halving = Halving::default();
    for state in states.iter_mut().flatten() {
        halving = halving.onto(state, reach);
    }
    halving = Halving::default();
    for state in states
        .iter_mut()
        .rev()
        .flat_map(|block| block.iter_mut().rev())
    {
        halving = halving.onto(state, reach);
    }
}

/// A halving on its way along the path.
#[derive(Debug, Clone, Copy, Default)]
struct Halving {
    /// Over how many further segments it spreads.
    left: usize,
    /// Over how many calm segments in a row it may still pass.
    gap: usize,
}

impl Halving {
    /// Goes on to the next segment.
    fn onto(self, state: &mut SegmentState, reach: usize) -> Self {
        let left = self.left.saturating_sub(1);
        match *state {
            SegmentState::Beyond => Self {
                left: reach,
                gap: GAP,
            },
            SegmentState::Near | SegmentState::Reached if self.left > 0 => {
                *state = SegmentState::Reached;
                Self { left, gap: GAP }
            }
            SegmentState::Calm if self.left > 0 && self.gap > 0 => Self {
                left,
                gap: self.gap - 1,
            },
            _ => Self::default(),
        }
    }
}

/// Halves the segments that are beyond the aim or reached by a halving. Gives the blocks that
/// changed.
fn halve(depths: &mut [Depths], states: &mut [Vec<SegmentState>]) -> Vec<usize> {
    let mut changed = Vec::new();
    for (index, (depths, states)) in depths.iter_mut().zip(states).enumerate() {
        let is_halved =
            |state: &SegmentState| matches!(state, SegmentState::Beyond | SegmentState::Reached);
        if !states.iter().any(is_halved) {
            continue;
        }
        changed.push(index);
        depths.resize(states.len(), 0);
        for (depth, state) in depths.iter_mut().zip(states.iter_mut()) {
            *depth += u8::from(is_halved(state));
            *state = SegmentState::Calm;
        }
    }
    changed
}

/// Plays a block back and gives the state of each of its sampler segments.
fn play(plan: &Plan<'_>, block: &BlockPoints) -> Result<Vec<SegmentState>> {
    let segments = block.owner.last().map_or(0, |last| *last as usize + 1);
    let mut states = vec![SegmentState::Calm; segments];
    if block.points.len() > MOST_POINTS {
        return Ok(states);
    }
    let touch = &plan.preparation.touch;
    let errors = Meter::segment_errors(touch, &block.points).map_err(PipelineError::Measure)?;
    let aim = AIM * plan.preparation.task.tolerance.interpolation;
    let drifts = drift::loads(plan, block)?;
    let loads = errors
        .iter()
        .zip(drifts)
        .map(|(error, drift)| drift.max(error / aim));
    let times = block.points.t.windows(2);
    for ((load, owner), time) in loads.zip(&block.owner).zip(times) {
        let state = &mut states[*owner as usize];
        let long_enough = time[1] - time[0] >= 2.0 * SMALLEST_SEGMENT;
        if long_enough && load > 1.0 {
            *state = SegmentState::Beyond;
        } else if long_enough && load > NEAR && *state == SegmentState::Calm {
            *state = SegmentState::Near;
        }
    }
    Ok(states)
}

/// The blocks that change when the `halved` ones do; `counts` has the nodes of each block.
fn affected(
    dependence: Dependence,
    counts: &[usize],
    halved: impl Iterator<Item = usize>,
) -> Vec<usize> {
    let mut is_affected = vec![false; counts.len()];
    for index in halved {
        let range = match dependence {
            Dependence::Sequential => 0..counts.len(),
            // The block before ends at this block's first node, which no halving moves.
            Dependence::Local => index..index + 1,
            Dependence::Overlap(overlap) => within_overlap(overlap, counts, index),
        };
        is_affected[range].fill(true);
    }
    (0..counts.len())
        .filter(|index| is_affected[*index])
        .collect()
}

/// The blocks that see a node of block `index` among the `overlap` nodes of their neighbours.
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

/// Runs of consecutive blocks, of at most `batch` blocks each.
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
        let affected = |dependence, counts: &[usize], index: usize| {
            affected(dependence, counts, std::iter::once(index))
        };
        let overlap = Dependence::Overlap(64);
        assert_eq!(affected(overlap, &[500; 5], 2), [1, 2, 3]);
        assert_eq!(affected(overlap, &[500, 500, 40, 500, 1], 3), [1, 2, 3, 4]);
        assert_eq!(affected(Dependence::Local, &[500; 3], 1), [1]);
        assert_eq!(affected(Dependence::Sequential, &[500; 3], 2), [0, 1, 2]);
    }

    #[test]
    fn a_halving_spreads_over_neighbours_that_are_near_the_aim() {
        use SegmentState::{Beyond, Calm, Near, Reached};
        let mut states = vec![vec![Near, Calm, Near, Near], vec![Near, Beyond, Near, Calm]];
        spread(&mut states, 2);
        assert_eq!(states[0], [Near, Calm, Near, Reached]);
        assert_eq!(states[1], [Reached, Beyond, Reached, Calm]);
        let mut depths = vec![Depths::new(); 2];
        assert_eq!(halve(&mut depths, &mut states), [0, 1]);
        assert_eq!(depths, [vec![0, 0, 0, 1], vec![1, 1, 1, 0]]);
    }

    /// Where every second segment is halved already, a halving passes over the calm ones between.
    #[test]
    fn a_halving_spreads_over_one_calm_segment_at_a_time() {
        use SegmentState::{Beyond, Calm, Near, Reached};
        let mut states = vec![vec![Beyond, Calm, Near, Calm, Near, Calm, Calm, Near]];
        spread(&mut states, 16);
        let expected = [Beyond, Calm, Reached, Calm, Reached, Calm, Calm, Near];
        assert_eq!(states[0], expected);
        let mut states = vec![vec![Near, Calm], vec![Near, Calm, Beyond]];
        spread(&mut states, 3);
        assert_eq!(states, [vec![Near, Calm], vec![Reached, Calm, Beyond]]);
    }

    #[test]
    fn runs_are_consecutive_and_at_most_a_batch_long() {
        assert_eq!(runs(&[0, 1, 2, 5, 6, 9], 2), [0..2, 2..3, 5..7, 9..10]);
        assert!(runs(&[], 4).is_empty());
    }
}
