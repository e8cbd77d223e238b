//! Refinement: segments whose played error exceeds the tolerance are halved, in global rounds.
//!
//! What is kept between rounds is one small number for each sampler segment, and only blocks that
//! changed, or whose neighbours did, are made again.

use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::Dependence;
use turnpath_verify::Meter;

use crate::make::{Depths, Made, make};
use crate::order::in_order;
use crate::plan::Plan;
use crate::progress::{Progress, Stage};
use crate::{PipelineError, Result};

/// Part of the tolerance that refinement aims at: what the instants of a playback can miss, and
/// a little for whoever measures again.
pub const AIM: f64 = 0.99;
/// Most rounds: a segment ends as 1/4096 of the sampler's at the least.
pub const MOST_ROUNDS: u32 = 12;
/// Smallest segment that is made, s. Controllers take some 0.4 ms for a servo cycle; a tenth of
/// a millisecond is below what any of them can follow.
pub const SMALLEST_SEGMENT: f64 = 1e-4;
/// Control points of a block above which none of its segments is halved any more: a tolerance
/// that asks for so many (tens of thousands a revolution) is missed, and said to be, before the
/// memory is gone.
const MOST_POINTS: usize = 1_000_000;

/// Halves segments until the played error is below the aim everywhere or no segment can be
/// halved any more; gives how often each sampler segment is halved.
pub fn refine(plan: &Plan<'_>, batch: usize, progress: &dyn Progress) -> Result<Vec<Depths>> {
    let mut depths: Vec<Depths> = vec![Depths::new(); plan.blocks()];
    let mut dirty: Vec<usize> = (0..plan.blocks()).collect();
    let mut counts = vec![0; plan.blocks()];
    for round in 1..=MOST_ROUNDS {
        progress.begin(Stage::Refine(round), dirty.len() as u64);
        let mut halved = Vec::new();
        let mut state = first_state(plan);
        for range in runs(&dirty, batch) {
            let made = make(plan, range.clone(), &depths, state.as_mut())?;
            let each = made.par_iter().zip(range.clone());
            let deeper = in_order(each.map(|(made, index)| deepen(plan, made, &depths[index])))?;
            for ((index, deeper), made) in range.clone().zip(deeper).zip(&made) {
                counts[index] = made.owner.len();
                if let Some(deeper) = deeper {
                    halved.push((index, deeper));
                }
            }
            progress.advance(range.len() as u64);
        }
        if halved.is_empty() {
            break;
        }
        let dependence = plan.chain.velocity.strategy.dependence();
        dirty = touched(dependence, &counts, halved.iter().map(|(index, _)| *index));
        for (index, deeper) in halved {
            depths[index] = deeper;
        }
    }
    Ok(depths)
}

/// The state that a sequential solver starts with; nothing for others.
pub fn first_state(plan: &Plan<'_>) -> Option<Vec<f64>> {
    let sequential = plan.chain.velocity.strategy.dependence() == Dependence::Sequential;
    sequential.then(Vec::new)
}

/// The block's depths with one more for every segment that is too far off, if there is one.
fn deepen(plan: &Plan<'_>, made: &Made, depths: &Depths) -> Result<Option<Depths>> {
    let touch = &plan.prepared.touch;
    if made.points.len() > MOST_POINTS {
        return Ok(None);
    }
    let errors = Meter::segment_errors(touch, &made.points).map_err(PipelineError::Measure)?;
    let aim = AIM * plan.prepared.job.tolerance.interpolation;
    let segments = made.owner.last().map_or(0, |last| *last as usize + 1);
    let mut too_far = vec![false; segments];
    let times = made.points.t.windows(2);
    for ((error, owner), time) in errors.iter().zip(&made.owner).zip(times) {
        let long_enough = time[1] - time[0] >= 2.0 * SMALLEST_SEGMENT;
        if *error > aim && long_enough {
            too_far[*owner as usize] = true;
        }
    }
    if !too_far.contains(&true) {
        return Ok(None);
    }
    let mut deeper = depths.clone();
    deeper.resize(segments, 0);
    for (depth, too_far) in deeper.iter_mut().zip(too_far) {
        *depth += u8::from(too_far);
    }
    Ok(Some(deeper))
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
    fn runs_are_rows_of_at_most_a_batch() {
        assert_eq!(runs(&[0, 1, 2, 5, 6, 9], 2), [0..2, 2..3, 5..7, 9..10]);
        assert!(runs(&[], 4).is_empty());
    }
}
