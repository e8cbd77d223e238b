//! What a playback shows of each sampler segment: whether it is to be halved.

use std::ops::Range;

use turnpath_verify::Meter;

use crate::aim::{AIM, NEAR};
use crate::drift;
use crate::make::BlockPoints;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Smallest segment that refinement makes, s. Controllers take some 0.4 ms for a servo cycle; none
/// can follow a tenth of a millisecond.
pub const SMALLEST_SEGMENT: f64 = 1e-4;
/// Control points of a block above which none of its segments is halved any more. A tolerance that
/// needs so many (tens of thousands a revolution) is missed and reported as missed, before memory
/// runs out.
const MOST_POINTS_OF_BLOCK: usize = 1_000_000;

/// Where sampler segments have so many parts in the mean, the middle of each part is played first. One part beyond
/// the aim decides for all of them, and the others need not be played in full.
const MANY_PARTS: usize = 4;
/// Fewer parts than this between two runs are played with them: a batch of a few would leave registers empty.
const FEW_PARTS: usize = 16;

/// What is known of a sampler segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SegmentState {
    /// Far from the aim, or as short as a segment may be.
    Calm,
    /// Near the aim.
    Near,
    /// Beyond the aim.
    Beyond,
    /// Near the aim, and a halving has spread to it.
    Reached,
    /// Not known: its points have changed since the last playback.
    Stale,
}

/// Plays a block back and gives the state of each of its sampler segments. Those that are `known`, and not stale, are
/// not played; the list is empty before the first playback.
pub fn play(
    plan: &Plan<'_>,
    block: &BlockPoints,
    known: &[SegmentState],
) -> Result<Vec<SegmentState>> {
    if block.points.len() > MOST_POINTS_OF_BLOCK {
        return Ok(all_calm(block));
    }
    let (touch, points) = (&plan.preparation.touch, &block.points);
    let mut review = Review::begin(plan, block, known)?;
    let mut runs = review.open_runs();
    if review.has_many_parts(&runs) {
        let errors = Meter::errors_at_middles(touch, points, &runs);
        review.include(&runs, &errors.map_err(PipelineError::Measure)?);
        runs = review.open_runs();
    }
    let limits = [NEAR * review.aim, review.aim];
    let errors = Meter::errors_against(touch, points, &runs, &limits);
    review.include(&runs, &errors.map_err(PipelineError::Measure)?);
    Ok(review.states)
}

/// The state of each sampler segment of a block whose segments err by so much as they are played, mm.
pub fn states(plan: &Plan<'_>, block: &BlockPoints, errors: &[f64]) -> Result<Vec<SegmentState>> {
    if block.points.len() > MOST_POINTS_OF_BLOCK {
        return Ok(all_calm(block));
    }
    let mut review = Review::begin(plan, block, &[])?;
    review.include(&review.open_runs(), errors);
    Ok(review.states)
}

/// The states of a block's sampler segments as far as they are known. Each sampler segment has one or more of the
/// block's segments as its parts.
struct Review<'a> {
    block: &'a BlockPoints,
    states: Vec<SegmentState>,
    /// Whether the state of each is to be found.
    is_wanted: Vec<bool>,
    /// The error that refinement aims at, mm.
    aim: f64,
    /// X's error of each part of the block, as [`drift::loads`] gives it.
    drifts: Vec<f64>,
}

impl<'a> Review<'a> {
    fn begin(plan: &Plan<'_>, block: &'a BlockPoints, known: &[SegmentState]) -> Result<Self> {
        let mut states = all_calm(block);
        let mut is_wanted = vec![true; states.len()];
        for ((state, is_wanted), known) in states.iter_mut().zip(&mut is_wanted).zip(known) {
            if *known != SegmentState::Stale {
                (*state, *is_wanted) = (*known, false);
            }
        }
        Ok(Self {
            block,
            states,
            is_wanted,
            aim: AIM * plan.preparation.task.tolerance.interpolation,
            drifts: drift::loads(plan, block)?,
        })
    }

    /// Includes errors of runs of parts, mm. Those of a state that is known change nothing.
    fn include(&mut self, runs: &[Range<usize>], errors: &[f64]) {
        for (part, error) in runs.iter().cloned().flatten().zip(errors) {
            let state = &mut self.states[self.block.owner[part] as usize];
            let load = self.drifts[part].max(error / self.aim);
            let time = self.block.points.t[part + 1] - self.block.points.t[part];
            let long_enough = time >= 2.0 * SMALLEST_SEGMENT;
            if long_enough && load > 1.0 {
                *state = SegmentState::Beyond;
            } else if long_enough && load > NEAR && *state == SegmentState::Calm {
                *state = SegmentState::Near;
            }
        }
    }

    /// Runs of parts whose sampler segments may still get another state. A few others between two runs go with them.
    fn open_runs(&self) -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        let owners = self.block.owner.iter().take(self.drifts.len());
        for (part, owner) in owners.enumerate() {
            let owner = *owner as usize;
            if !self.is_wanted[owner] || self.states[owner] == SegmentState::Beyond {
                continue;
            }
            match runs.last_mut() {
                Some(run) if part - run.end < FEW_PARTS => run.end = part + 1,
                _ => runs.push(part..part + 1),
            }
        }
        runs
    }

    /// Whether the sampler segments that are wanted have [`MANY_PARTS`] in the mean.
    fn has_many_parts(&self, runs: &[Range<usize>]) -> bool {
        let parts: usize = runs.iter().map(Range::len).sum();
        let wanted = self.is_wanted.iter().filter(|is_wanted| **is_wanted);
        parts >= MANY_PARTS * wanted.count()
    }
}

fn all_calm(block: &BlockPoints) -> Vec<SegmentState> {
    let segments = block.owner.last().map_or(0, |last| *last as usize + 1);
    vec![SegmentState::Calm; segments]
}
