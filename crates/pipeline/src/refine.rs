//! Refinement halves, in global rounds, the segments whose played error exceeds the tolerance. It
//! also halves those where X's own error would raise a cusp beyond the residual ([`crate::drift`]).
//!
//! Refinement keeps two bytes for each sampler segment between rounds: how often the segment is
//! halved, and its state after the last playback. A block is made again if one of its segments is
//! [stale](crate::stale). Only its stale segments are played. The first round may be the making of
//! the path itself: who plays a block there tells the refinement its states ([`Refinement::take`]).
//!
//! With a spline, the error of a long segment rises when its neighbour is halved. Where all
//! segments are near the tolerance, halving only those beyond it would move the border between
//! short and long segments by one segment a round. So a halving spreads from a segment that is
//! beyond the tolerance over its neighbours that are near it, four times as far every round. It
//! passes over a calm segment between them.

use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::Dependence;

use crate::Result;
use crate::make::{BlockPoints, Depths, close_joints, first_state, make};
use crate::observer::{Observer, Stage, stop_if_cancelled};
use crate::order::one_at_a_time;
use crate::plan::Plan;
use crate::segment_state::{SegmentState, play};
use crate::stale::HalvedPath;

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

/// How often each sampler segment is halved, and what its last playback showed.
pub struct Refinement {
    depths: Vec<Depths>,
    states: Vec<Vec<SegmentState>>,
    /// Whether each block was played.
    played: Vec<bool>,
}

/// Halves segments until the played error is below the aim everywhere, or no segment can be halved
/// any more. Gives how often each sampler segment is halved. Only the `chosen` blocks are refined, in
/// their order, `batch` of them at a time. The others have no depths of their own. A sequential solver
/// needs all blocks: what it makes of one follows from those before.
pub fn refine(
    plan: &Plan<'_>,
    batch: usize,
    chosen: &[usize],
    observer: &dyn Observer,
) -> Result<Vec<Depths>> {
    let mut refinement = Refinement::new(plan);
    refinement.play_round(1, plan, batch, chosen, observer)?;
    refinement.finish(plan, batch, chosen, observer)
}

impl Refinement {
    /// Nothing is halved, and nothing has been played.
    pub fn new(plan: &Plan<'_>) -> Self {
        Self {
            depths: vec![Depths::new(); plan.blocks()],
            states: vec![Vec::new(); plan.blocks()],
            played: vec![false; plan.blocks()],
        }
    }

    /// Takes what the playback of a block shows of its segments.
    pub fn take(&mut self, block: usize, states: Vec<SegmentState>) {
        self.states[block] = states;
        self.played[block] = true;
    }

    /// Plays the stale segments of blocks back.
    pub fn play(&mut self, plan: &Plan<'_>, blocks: &[BlockPoints]) -> Result<()> {
        let known = |block: &BlockPoints| self.states[block.index].as_slice();
        let played = blocks
            .par_iter()
            .map(|block| play(plan, block, known(block)));
        let played = one_at_a_time(played)?;
        for (block, states) in blocks.iter().zip(played) {
            self.take(block.index, states);
        }
        Ok(())
    }

    /// Refines after the first round, in which all `chosen` blocks were played.
    pub fn finish(
        mut self,
        plan: &Plan<'_>,
        batch: usize,
        chosen: &[usize],
        observer: &dyn Observer,
    ) -> Result<Vec<Depths>> {
        let dependence = plan.chain.velocity.strategy.dependence();
        let blocks = 0..plan.blocks();
        let sources: Vec<usize> = blocks.map(|index| plan.halved_as(index)).collect();
        for round in 1..=MOST_ROUNDS {
            spread(&mut self.states, &self.played, reach(dependence, round));
            let halved = halve(&mut self.depths, &mut self.states);
            if halved.is_empty() || round == MOST_ROUNDS {
                break;
            }
            let path = HalvedPath {
                depths: &self.depths,
                sources: &sources,
                halved: &halved,
            };
            path.spread_stale(&mut self.states, dependence);
            let is_stale = |index: &usize| self.states[*index].contains(&SegmentState::Stale);
            let stale: Vec<usize> = chosen.iter().copied().filter(is_stale).collect();
            self.play_round(round + 1, plan, batch, &stale, observer)?;
        }
        Ok(self.depths)
    }

    /// Makes these blocks and plays their stale segments back.
    fn play_round(
        &mut self,
        round: u32,
        plan: &Plan<'_>,
        batch: usize,
        dirty: &[usize],
        observer: &dyn Observer,
    ) -> Result<()> {
        observer.begin(Stage::Refine(round), dirty.len() as u64);
        let mut solver_state = first_state(plan);
        // The last block that was made waits for the first point of the next one.
        let mut waiting: Option<BlockPoints> = None;
        let mut batches = dirty.chunks(batch.max(1)).peekable();
        while let Some(some) = batches.next() {
            stop_if_cancelled(observer)?;
            let made = self.make_runs(plan, &runs(some), solver_state.as_mut())?;
            let mut blocks: Vec<BlockPoints> = waiting.take().into_iter().chain(made).collect();
            close_joints(&mut blocks);
            if batches.peek().is_some() {
                waiting = blocks.pop();
            }
            self.play(plan, &blocks)?;
            observer.advance(some.len() as u64);
        }
        Ok(())
    }

    /// Makes runs of blocks: in parallel, unless the solver takes its state from one to the next.
    fn make_runs(
        &self,
        plan: &Plan<'_>,
        runs: &[Range<usize>],
        solver_state: Option<&mut Vec<f64>>,
    ) -> Result<Vec<BlockPoints>> {
        let depths = &self.depths;
        let made = match solver_state {
            Some(state) => {
                let each = runs.iter().cloned();
                let made = each.map(|run| make(plan, run, depths, Some(&mut *state)));
                made.collect::<Result<Vec<_>>>()?
            }
            None => one_at_a_time(
                runs.par_iter()
                    .map(|run| make(plan, run.clone(), depths, None)),
            )?,
        };
        Ok(made.into_iter().flatten().collect())
    }
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

/// Spreads halvings forward and backward along the path, over the borders of blocks that were played.
fn spread(states: &mut [Vec<SegmentState>], played: &[bool], reach: usize) {
    let mut halving = Halving::default();
    for (block, is_played) in states.iter_mut().zip(played) {
        halving = halving.onto_block(block.iter_mut(), *is_played, reach);
    }
    halving = Halving::default();
    for (block, is_played) in states.iter_mut().zip(played).rev() {
        halving = halving.onto_block(block.iter_mut().rev(), *is_played, reach);
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
    /// Goes over the segments of a block, in their order. It ends at a block that was not played.
    fn onto_block<'a>(
        self,
        block: impl Iterator<Item = &'a mut SegmentState>,
        is_played: bool,
        reach: usize,
    ) -> Self {
        match is_played {
            true => block.fold(self, |halving, state| halving.onto(state, reach)),
            false => Self::default(),
        }
    }

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

/// Halves the segments that are beyond the aim or reached by a halving, which makes them stale. Gives
/// the blocks that changed.
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
            if is_halved(state) {
                *depth += 1;
                *state = SegmentState::Stale;
            }
        }
    }
    changed
}

/// Runs of consecutive blocks.
fn runs(blocks: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for index in blocks {
        match runs.last_mut() {
            Some(run) if run.end == *index => run.end += 1,
            _ => runs.push(*index..*index + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_halving_spreads_over_neighbours_that_are_near_the_aim() {
        use SegmentState::{Beyond, Calm, Near, Reached, Stale};
        let mut states = vec![vec![Near, Calm, Near, Near], vec![Near, Beyond, Near, Calm]];
        spread(&mut states, &[true; 2], 2);
        assert_eq!(states[0], [Near, Calm, Near, Reached]);
        assert_eq!(states[1], [Reached, Beyond, Reached, Calm]);
        let mut depths = vec![Depths::new(); 2];
        assert_eq!(halve(&mut depths, &mut states), [0, 1]);
        assert_eq!(depths, [vec![0, 0, 0, 1], vec![1, 1, 1, 0]]);
        assert_eq!(states[0], [Near, Calm, Near, Stale]);
        assert_eq!(states[1], [Stale, Stale, Stale, Calm]);
    }

    /// Where every second segment is halved already, a halving passes over the calm ones between.
    #[test]
    fn a_halving_spreads_over_one_calm_segment_at_a_time() {
        use SegmentState::{Beyond, Calm, Near, Reached};
        let mut states = vec![vec![Beyond, Calm, Near, Calm, Near, Calm, Calm, Near]];
        spread(&mut states, &[true], 16);
        let expected = [Beyond, Calm, Reached, Calm, Reached, Calm, Calm, Near];
        assert_eq!(states[0], expected);
        let mut states = vec![vec![Near, Calm], vec![Near, Calm, Beyond]];
        spread(&mut states, &[true; 2], 3);
        assert_eq!(states, [vec![Near, Calm], vec![Reached, Calm, Beyond]]);
    }

    /// A sample has blocks here and there. A block that was played may have no segment of its own.
    #[test]
    fn a_halving_spreads_over_blocks_that_were_played_alone() {
        use SegmentState::{Beyond, Near, Reached};
        let blocks = [vec![Near], vec![], vec![Beyond], vec![Near], vec![Near]];
        let mut states = blocks.clone();
        spread(&mut states, &[true, true, true, false, true], 4);
        let [_, none, beyond, ..] = blocks.clone();
        assert_eq!(
            states,
            [vec![Reached], none, beyond, vec![Near], vec![Near]]
        );
    }

    #[test]
    fn runs_are_consecutive() {
        assert_eq!(runs(&[0, 1, 2, 5, 6, 9]), [0..3, 5..7, 9..10]);
        assert!(runs(&[]).is_empty());
    }
}
