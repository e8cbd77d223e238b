//! What a playback shows of each sampler segment: whether it is to be halved.

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

/// The state of a sampler segment after its last playback.
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
}

/// Plays a block back and gives the state of each of its sampler segments.
pub fn play(plan: &Plan<'_>, block: &BlockPoints) -> Result<Vec<SegmentState>> {
    if block.points.len() > MOST_POINTS_OF_BLOCK {
        return Ok(all_calm(block));
    }
    let touch = &plan.preparation.touch;
    let errors = Meter::segment_errors(touch, &block.points).map_err(PipelineError::Measure)?;
    states(plan, block, &errors)
}

/// The state of each sampler segment of a block whose segments err by so much as they are played, mm.
pub fn states(plan: &Plan<'_>, block: &BlockPoints, errors: &[f64]) -> Result<Vec<SegmentState>> {
    let mut states = all_calm(block);
    if block.points.len() > MOST_POINTS_OF_BLOCK {
        return Ok(states);
    }
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

fn all_calm(block: &BlockPoints) -> Vec<SegmentState> {
    let segments = block.owner.last().map_or(0, |last| *last as usize + 1);
    vec![SegmentState::Calm; segments]
}
