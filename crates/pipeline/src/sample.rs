//! Some blocks of a path nearly as a run makes them, from which the sizes of its files follow before it is made.
//! What a velocity solver sees beyond such a block are nodes of the sample, if the sampler begins afresh at each
//! block. Their segments are halved as those of the sample.

use rayon::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};
use turnpath_verify::AxesMotion;

use crate::estimate::Estimate;
use crate::lead::{LeadRun, LeadTask};
use crate::make::{BlockPoints, Depths, first_state, is_sequential, make};
use crate::observer::SilentObserver;
use crate::options::PathOptions;
use crate::order::one_at_a_time;
use crate::plan::Plan;
use crate::refine::refine;
use crate::repeated_blocks::RepeatedBlocks;
use crate::{Chain, Preparation, Result, schedule};

/// About how many blocks are made. The count of points on a revolution changes smoothly along a path,
/// but what refinement adds does not: with eight places the table of one recipe of the documentation was
/// a tenth too small. More places cost time.
const SAMPLED_BLOCKS: usize = 16;

/// A last step of more than this part of the one before is whole: its border lies where a step ends, but for
/// rounding, or a controller's step of time.
const WHOLE_STEP: f64 = 0.99;

/// Some blocks of a path, refined, and its leads.
#[derive(Debug, Clone, Default)]
pub struct PathSample {
    /// The blocks, in the order of the path.
    pub blocks: Vec<SampledBlock>,
    /// The leads; empty for a path without.
    pub leads: Vec<(Section, PathBlock)>,
}

/// A block that stands for its neighbours.
#[derive(Debug, Clone)]
pub struct SampledBlock {
    /// Its control points, with the one at which the next block begins.
    pub points: PathBlock,
    /// Revolutions of the path that it stands for, over its own.
    pub stands_for: f64,
    /// Segments that it would have without its border, over those that it has. The border of a block that was
    /// made small for the sample cuts its last step off.
    pub without_border: f64,
}

impl SampledBlock {
    /// How many times its own segments the path has where it stands for it.
    pub fn segments_for_each(&self) -> f64 {
        self.stands_for * self.without_border
    }

    /// Segments of the path that it stands for.
    fn segments(&self) -> f64 {
        self.points.len().saturating_sub(1) as f64 * self.segments_for_each()
    }
}

/// The estimate of a path as refinement leaves it, and a sample of it.
///
/// # Errors
/// When a strategy fails.
pub fn sample_path(
    chain: &Chain,
    preparation: &Preparation,
    options: PathOptions,
) -> Result<(Estimate, PathSample)> {
    let observer = &SilentObserver;
    let mut plan = schedule::plan(chain, preparation, observer)?;
    plan.time_steps = options.time_steps;
    let whole_block = plan.block();
    // What refinement does with a block of such a path follows from all blocks before.
    let refines_whole_path = options.refine && is_sequential(&plan);
    match refines_whole_path {
        true => plan.hold_nodes(),
        false => plan.divide_for_sample(),
    }
    let are_cut = plan.block() < whole_block;
    let strata = strata(plan.blocks());
    let depths = match refines_whole_path {
        true => refine(&plan, SAMPLED_BLOCKS, &all_blocks(&plan), observer)?,
        false => {
            let chosen: Vec<usize> = strata.iter().map(|stratum| stratum.chosen).collect();
            plan.repeat(RepeatedBlocks::of(&chosen, plan.blocks()))?;
            match options.refine {
                true => refine(&plan, SAMPLED_BLOCKS, &chosen, observer)?,
                false => Vec::new(),
            }
        }
    };
    let leads = options
        .lead
        .map(|settings| {
            let task = LeadTask::new(&plan, settings)?;
            LeadRun::begin(&mut plan, &depths, task)
        })
        .transpose()?;
    let block = |stratum: &Stratum| sampled_block(&plan, stratum, &depths, are_cut);
    let blocks = one_at_a_time(strata.par_iter().map(block))?;
    let segments: f64 = blocks.iter().map(SampledBlock::segments).sum();
    let estimate = Estimate::of(&plan, segments / plan.law.end())?;
    let leads = match leads.zip(blocks.last()) {
        Some((leads, last)) => both_leads(&plan, leads, &last.points)?,
        None => Vec::new(),
    };
    Ok((estimate, PathSample { blocks, leads }))
}

fn all_blocks(plan: &Plan<'_>) -> Vec<usize> {
    (0..plan.blocks()).collect()
}

/// The block that stands for a stratum. `are_cut` says that blocks were made smaller for the sample.
fn sampled_block(
    plan: &Plan<'_>,
    stratum: &Stratum,
    depths: &[Depths],
    are_cut: bool,
) -> Result<SampledBlock> {
    let block = block(plan, stratum.chosen, depths)?;
    let is_cut = are_cut && plan.repeats_nodes() && !plan.is_last(stratum.chosen);
    let without_border = match is_cut {
        true => without_border(&block.points.c, &block.owner),
        false => 1.0,
    };
    Ok(SampledBlock {
        points: block.points,
        stands_for: stratum.stands_for(plan),
        without_border,
    })
}

/// The lead-in, and the lead-out behind the last block of the cut.
fn both_leads(
    plan: &Plan<'_>,
    leads: LeadRun,
    last: &PathBlock,
) -> Result<Vec<(Section, PathBlock)>> {
    let mut both = vec![(Section::LeadIn, leads.lead_in())];
    if let Some(pair) = last_two(last) {
        let (points, _) = leads.end(plan, &pair, AxesMotion::of(last))?;
        both.push((Section::LeadOut, points));
    }
    Ok(both)
}

/// Neighbouring blocks, and the one that stands for them.
struct Stratum {
    first: usize,
    end: usize,
    chosen: usize,
}

impl Stratum {
    /// Revolutions of all its blocks, over those of the chosen one.
    fn stands_for(&self, plan: &Plan<'_>) -> f64 {
        let turns =
            |first: usize, last: usize| plan.revolutions(last).end - plan.revolutions(first).start;
        turns(self.first, self.end - 1) / turns(self.chosen, self.chosen)
    }
}

/// The first and the last block stand for themselves, as leads join them; the middle one of each stretch
/// between them for all of it.
fn strata(blocks: usize) -> Vec<Stratum> {
    let alone = |index: usize| Stratum {
        first: index,
        end: index + 1,
        chosen: index,
    };
    if blocks <= SAMPLED_BLOCKS {
        return (0..blocks).map(alone).collect();
    }
    let (inner, parts) = (blocks - 2, SAMPLED_BLOCKS - 2);
    let border = |part: usize| 1 + part * inner / parts;
    let stretch = |part: usize| {
        let (first, end) = (border(part), border(part + 1));
        Stratum {
            first,
            end,
            chosen: (first + end) / 2,
        }
    };
    let mut strata = vec![alone(0)];
    strata.extend((0..parts).map(stretch));
    strata.push(alone(blocks - 1));
    strata
}

/// One block. It is made, so there is one.
fn block(plan: &Plan<'_>, index: usize, depths: &[Depths]) -> Result<BlockPoints> {
    let blocks = make(plan, index..index + 1, depths, first_state(plan).as_mut())?;
    Ok(blocks.into_iter().next().unwrap_or_default())
}

/// How many segments a block would have without its border, over those that it has. The border of a small
/// block cuts the sampler's last step off, and in the path there are fewer borders. `owner` says of which
/// step each segment is a part.
fn without_border(c: &[f64], owner: &[u32]) -> f64 {
    let steps: Vec<&[u32]> = owner.chunk_by(|one, other| one == other).collect();
    let [.., before, last] = steps[..] else {
        return 1.0;
    };
    let whole = owner.len() - last.len();
    let [Some(from), Some(middle), Some(end)] =
        [whole - before.len(), whole, owner.len()].map(|place| c.get(place))
    else {
        return 1.0;
    };
    let part = (end - middle) / (middle - from);
    let (before, of_each) = (steps.len() - 1, whole as f64 / (steps.len() - 1) as f64);
    match part < WHOLE_STEP {
        true => of_each * (before as f64 + part) / owner.len() as f64,
        false => 1.0,
    }
}

fn last_two(points: &PathBlock) -> Option<[ControlPoint; 2]> {
    let count = points.len();
    Some([
        points.get(count.checked_sub(2)?)?,
        points.get(count.checked_sub(1)?)?,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_the_border_cuts_off_counts_as_its_part() {
        assert_eq!(
            without_border(&[0.0, 1.0, 2.0, 2.25], &[0, 1, 2]),
            2.25 / 3.0
        );
        assert_eq!(without_border(&[0.0, 1.0, 2.0, 3.0], &[0, 1, 2]), 1.0);
        assert_eq!(without_border(&[0.0, 1.0, 2.0, 4.0], &[0, 1, 2]), 1.0);
        assert_eq!(without_border(&[0.0, 1.0], &[0]), 1.0);
        assert_eq!(without_border(&[], &[]), 1.0);
        // Rounding cuts nothing off, however many segments the steps before have.
        assert_eq!(
            without_border(&[0.0, 0.5, 1.0, 2.0 - 1e-12], &[0, 0, 1]),
            1.0
        );
        // Two steps of four segments each, and half a step of one.
        let c = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5];
        assert_eq!(without_border(&c, &[0, 0, 0, 0, 1, 1, 1, 1, 2]), 10.0 / 9.0);
    }

    #[test]
    fn each_block_has_one_that_stands_for_it() {
        for blocks in [1, 2, 16, 17, 33, 1000] {
            let strata = strata(blocks);
            assert!(strata.len() <= SAMPLED_BLOCKS);
            let mut next = 0;
            for stratum in &strata {
                assert_eq!(stratum.first, next);
                assert!((stratum.first..stratum.end).contains(&stratum.chosen));
                next = stratum.end;
            }
            assert_eq!(next, blocks);
        }
    }
}
