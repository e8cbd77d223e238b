//! Some blocks of a path nearly as a run makes them, from which the sizes of its files follow before it is made.
//! What a velocity solver sees beyond such a block are nodes of the sample, if the sampler begins afresh at each
//! block. Their segments are halved as those of the sample.

use rayon::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};
use turnpath_verify::AxesMotion;

use crate::estimate::Estimate;
use crate::lead::{LeadRun, LeadTask};
use crate::make::{BlockPoints, Depths, first_state, is_sequential, make};
use crate::observer::{Observer, Stage, stop_if_cancelled};
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

/// A step of less than this part of those beside it is the rest of one. Refinement halves steps, so that
/// neighbours differ by more than a factor of four at few places.
const SHORT_REST: f64 = 0.125;

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
    /// Its control points, with the one at which the next block begins. The border of a block that was made
    /// small for the sample cuts its last step off, which is left out: such a step may be shorter than any of
    /// the path.
    pub points: PathBlock,
    /// Revolutions of the path that it stands for, over its own.
    pub stands_for: f64,
    /// Segments that it would have without its border, over those that it has.
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
/// When a strategy fails, and when the observer cancels.
pub fn sample_path(
    chain: &Chain,
    preparation: &Preparation,
    options: PathOptions,
    observer: &dyn Observer,
) -> Result<(Estimate, PathSample)> {
    observer.begin(Stage::Law, 0);
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
    observer.begin(Stage::Sample, strata.len() as u64);
    let block = |stratum: &Stratum| {
        stop_if_cancelled(observer)?;
        let block = sampled_block(&plan, stratum, &depths, are_cut)?;
        observer.advance(1);
        Ok(block)
    };
    let sample = blocks_and_leads(&plan, &strata, block, leads)?;
    let segments: f64 = sample.blocks.iter().map(SampledBlock::segments).sum();
    let estimate = Estimate::of(&plan, segments / plan.law.end())?;
    Ok((estimate, sample))
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
    let BlockPoints {
        mut points, owner, ..
    } = block(plan, stratum.chosen, depths)?;
    let is_cut = are_cut && plan.repeats_nodes() && !plan.is_last(stratum.chosen);
    let cut_off = is_cut.then(|| CutOff::of(&points.c, &owner)).flatten();
    if let Some(cut_off) = &cut_off {
        points.truncate(cut_off.segments_before + 1);
    }
    if are_cut {
        points = without_rests(&points);
    }
    Ok(SampledBlock {
        points,
        stands_for: stratum.stands_for(plan),
        without_border: cut_off.map_or(1.0, |cut_off| cut_off.steps_for_each),
    })
}

/// The sampled blocks, and both leads. The lead-out is laid out behind the last block while the others are made.
fn blocks_and_leads(
    plan: &Plan<'_>,
    strata: &[Stratum],
    block: impl Fn(&Stratum) -> Result<SampledBlock> + Sync,
    leads: Option<LeadRun>,
) -> Result<PathSample> {
    let Some((last, others)) = strata.split_last() else {
        return Ok(PathSample::default());
    };
    let make_others = || one_at_a_time(others.par_iter().map(&block));
    let make_end = || -> Result<_> {
        let last = block(last)?;
        let leads = leads.map(|leads| both_leads(plan, leads, &last.points));
        Ok((last, leads.transpose()?.unwrap_or_default()))
    };
    let (others, end) = rayon::join(make_others, make_end);
    let (mut blocks, (last, leads)) = (others?, end?);
    blocks.push(last);
    Ok(PathSample { blocks, leads })
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

/// Joins each short rest of a step to the step before. A sampler begins afresh where a law has a border, and
/// the step before ends there. How much is left for it depends on where the steps begin, and in a sample they
/// begin elsewhere than in the path.
fn without_rests(points: &PathBlock) -> PathBlock {
    let duration = |from: usize| Some(points.t.get(from + 1)? - points.t.get(from)?);
    let is_short = |own: f64, beside: Option<f64>| beside.is_none_or(|of| own < SHORT_REST * of);
    let begins_rest = |from: usize| {
        let before = from.checked_sub(1).and_then(duration);
        let own = duration(from).filter(|own| before.is_some() && is_short(*own, before));
        own.is_some_and(|own| is_short(own, duration(from + 1)))
    };
    let kept = points.points().enumerate();
    let kept = kept.filter(|(from, _)| !begins_rest(*from));
    PathBlock::of(points.shape, kept.map(|(_, point)| point))
}

/// The last step of a block that its border cuts off. In the path there are fewer borders.
#[derive(Debug, PartialEq)]
struct CutOff {
    /// The segments of the steps before.
    segments_before: usize,
    /// The steps that the block would have without its border, over those before the last one.
    steps_for_each: f64,
}

impl CutOff {
    /// The step that is cut off, if the last one is. `owner` says of which step each segment is a part.
    fn of(c: &[f64], owner: &[u32]) -> Option<Self> {
        let steps: Vec<&[u32]> = owner.chunk_by(|one, other| one == other).collect();
        let [.., before, last] = steps[..] else {
            return None;
        };
        let segments_before = owner.len() - last.len();
        let begin = segments_before - before.len();
        let (from, middle, end) = (c.get(begin)?, c.get(segments_before)?, c.get(owner.len())?);
        let part = (end - middle) / (middle - from);
        let whole_steps = (steps.len() - 1) as f64;
        (part < WHOLE_STEP).then(|| Self {
            segments_before,
            steps_for_each: (whole_steps + part) / whole_steps,
        })
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
    use turnpath_core::toolpath::SegmentShape;

    use super::*;

    #[test]
    fn a_step_that_the_border_cuts_off_counts_as_its_part() {
        let cut_off = |segments_before, steps_for_each| {
            Some(CutOff {
                segments_before,
                steps_for_each,
            })
        };
        assert_eq!(
            CutOff::of(&[0.0, 1.0, 2.0, 2.25], &[0, 1, 2]),
            cut_off(2, 2.25 / 2.0)
        );
        assert_eq!(CutOff::of(&[0.0, 1.0, 2.0, 3.0], &[0, 1, 2]), None);
        assert_eq!(CutOff::of(&[0.0, 1.0, 2.0, 4.0], &[0, 1, 2]), None);
        assert_eq!(CutOff::of(&[0.0, 1.0], &[0]), None);
        assert_eq!(CutOff::of(&[], &[]), None);
        // Rounding cuts nothing off, however many segments the steps before have.
        let rounded = [0.0, 0.5, 1.0, 2.0 - 1e-12];
        assert_eq!(CutOff::of(&rounded, &[0, 0, 1]), None);
        // Two steps of four segments each, and half a step of one.
        let c = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5];
        let owner = [0, 0, 0, 0, 1, 1, 1, 1, 2];
        assert_eq!(CutOff::of(&c, &owner), cut_off(8, 2.5 / 2.0));
    }

    #[test]
    fn the_short_rest_of_a_step_belongs_to_the_step_before() {
        let times = |times: &[f64]| {
            let point = |t: &f64| ControlPoint {
                t: *t,
                ..ControlPoint::default()
            };
            let points = PathBlock::of(SegmentShape::Cubic, times.iter().map(point));
            without_rests(&points).t
        };
        assert_eq!(times(&[0.0, 1.0, 2.0, 2.1, 3.1]), [0.0, 1.0, 2.1, 3.1]);
        assert_eq!(times(&[0.0, 1.0, 2.0, 2.1]), [0.0, 1.0, 2.1]);
        assert_eq!(times(&[0.0, 1.0, 2.0, 2.2, 3.2]), [0.0, 1.0, 2.0, 2.2, 3.2]);
        // Halved steps, and a first one that no other stands before.
        assert_eq!(times(&[0.0, 0.1, 1.0, 2.0]), [0.0, 0.1, 1.0, 2.0]);
        assert_eq!(times(&[0.0, 1.0, 1.1, 1.2, 2.2]), [0.0, 1.0, 1.1, 1.2, 2.2]);
        assert_eq!(times(&[0.0]), [0.0]);
        assert!(times(&[]).is_empty());
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
