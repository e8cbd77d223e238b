//! The plan of a path whose spindle follows the machine's limits as the path is played.

use std::f64::consts::PI;

use turnpath_core::Machine;
use turnpath_core::toolpath::PathBlock;
use turnpath_verify::{AxesMotion, CertainMotion};

use crate::make::{BlockPoints, Depths, first_state, make};
use crate::observer::{Observer, stop_if_cancelled};
use crate::plan::Plan;
use crate::{Chain, Preparation, Result, spindle};

/// How often a schedule is planned again for the same nodes at the most.
const ROUNDS: usize = 3;
/// How often a sampler that takes the whole tolerance places its nodes again, for the schedule that
/// its last nodes asked for. Each time takes the sampler's time once more, against points that
/// refinement would add: with `minimax` 4 to 9 % of all on AST-5 without, up to 2 % with one, and none
/// with two. On MLA-5, with leads, two leave 0.14 %, and three none.
const PLACEMENTS: usize = 3;
/// A half turn counts as slow enough if its limits ask for no less than this part of its speed: a
/// tenth of the one factor with which limits are judged.
const ENOUGH: f64 = 0.9999;
/// A schedule is not planned again if the whole of it need not be slower than by this part: a longer
/// cut by a thousandth, against another round of planning.
const CLOSE: f64 = 0.999;
/// The whole schedule is not slowed down by more than this.
const LITTLE: f64 = 0.98;
/// For points of refinement the whole schedule is slowed down to this part at the least. Points that
/// ask for less stand at a jump, which no speed brings within the limits.
const LEAST_REFINED: f64 = 0.5;
/// An excess below this part is the rounding of points. By so much more a schedule is slowed down.
const ROUNDING: f64 = 1e-9;
/// The host asks for no less than this part of the speed that was planned first. A jump between two
/// points asks for next to nothing, and a strategy divides by factors.
const LEAST: f64 = 1e-3;
/// Blocks that are made at a time.
const BATCH: usize = 16;

/// Plans the path. If the spindle strategy follows factors and the machine has limits, its law is
/// planned again with the factors that the path as played asks for.
pub fn plan<'a>(
    chain: &'a Chain,
    preparation: &'a Preparation,
    observer: &dyn Observer,
) -> Result<Plan<'a>> {
    let mut plan = Plan::new(chain, preparation, observer)?;
    let strategy = &chain.spindle.strategy;
    if strategy.follows_factors() && preparation.task.machine.has_limits() {
        plan.hold_nodes();
        let least = hold_limits(&mut plan, observer)?;
        slow_down(&mut plan, least);
    }
    Ok(plan)
}

/// Plans the schedule until it holds the limits. A sampler that places nodes beside the path judges
/// its cubics as they are played, and leaves the errors of another schedule no room. So it places
/// its nodes again, and these ask for factors of their own. Gives the least headroom.
fn hold_limits(plan: &mut Plan<'_>, observer: &dyn Observer) -> Result<f64> {
    let takes_all = plan.chain.sampler.strategy.needs_exact_rates();
    let mut asked = Asked::new(plan);
    let (mut least, mut is_another) = follow(plan, &mut asked, observer)?;
    for _ in 0..PLACEMENTS {
        if !(takes_all && is_another) {
            break;
        }
        plan.place_again(observer)?;
        (least, is_another) = follow(plan, &mut asked, observer)?;
    }
    Ok(least)
}

/// What the host asks of a strategy, for each half turn, as parts of the largest speed.
struct Asked {
    factors: Vec<f64>,
    /// The smallest factors that are asked for.
    least: Vec<f64>,
}

impl Asked {
    /// Nothing yet.
    fn new(plan: &Plan<'_>) -> Self {
        let speed = plan.preparation.task.spindle_speed;
        let halves = half_turns(plan.law.end());
        let least = |half: usize| LEAST * fastest(plan, half) / speed;
        Self {
            factors: vec![1.0; halves],
            least: (0..halves).map(least).collect(),
        }
    }

    /// Lowers the factors where the present schedule leaves no headroom.
    fn lower(&mut self, plan: &Plan<'_>, headroom: &[f64]) {
        let speed = plan.preparation.task.spindle_speed;
        let factors = self.factors.iter_mut().zip(&self.least);
        for (half, ((factor, least), headroom)) in factors.zip(headroom).enumerate() {
            if *headroom < ENOUGH {
                let asked = headroom * fastest(plan, half) / speed;
                *factor = factor.min(asked).max(*least);
            }
        }
    }
}

/// Plans the schedule again for the present nodes, and asks for less where they need it. Gives
/// the least headroom, and whether the schedule is another one.
fn follow(plan: &mut Plan<'_>, asked: &mut Asked, observer: &dyn Observer) -> Result<(f64, bool)> {
    let mut round = 0;
    loop {
        let headroom = headroom(plan, &[], observer)?;
        let least = headroom.iter().copied().fold(1.0, f64::min);
        if least >= CLOSE || round == ROUNDS {
            return Ok((least, round > 0));
        }
        round += 1;
        asked.lower(plan, &headroom);
        let law = spindle::plan(plan.chain, plan.preparation, &plan.law, &asked.factors)?;
        plan.take_spindle(law);
    }
}

/// Slows the whole schedule down by what the points of refinement ask for beyond it: they were not
/// there when it was planned. Whether it did. The cubics stay as they are in the angle, so they keep
/// the tolerance. An excess that is not small stays, and the verdict shows it.
///
/// # Errors
/// If a block cannot be made, or the observer cancels the run.
pub fn slow_down_refined(
    plan: &mut Plan<'_>,
    depths: &[Depths],
    observer: &dyn Observer,
) -> Result<bool> {
    let is_refined = depths.iter().flatten().any(|depth| *depth > 0);
    let has_limits = plan.preparation.task.machine.has_limits();
    if !(is_refined && has_limits && plan.chain.spindle.strategy.follows_factors()) {
        return Ok(false);
    }
    let headroom = headroom(plan, depths, observer)?;
    let least = headroom.into_iter().fold(1.0, f64::min);
    if !(LEAST_REFINED..1.0 - ROUNDING).contains(&least) {
        return Ok(false);
    }
    plan.take_spindle(plan.spindle.scaled(least * (1.0 - ROUNDING)));
    Ok(true)
}

/// Slows the whole schedule down by the little that is left of an excess. The motion of all axes
/// scales with it, so that it then holds the limits. An excess that is not little stays, and the
/// verdict shows it.
fn slow_down(plan: &mut Plan<'_>, least: f64) {
    if (LITTLE..1.0 - ROUNDING).contains(&least) {
        plan.take_spindle(plan.spindle.scaled(least * (1.0 - ROUNDING)));
    }
}

fn half_turns(end: f64) -> usize {
    (2.0 * end).ceil() as usize
}

/// The largest speed at the ends and in the middle of a half turn, rad/s.
fn fastest(plan: &Plan<'_>, half: usize) -> f64 {
    let speed = |part: f64| plan.spindle.speed_at(0.5 * (half as f64 + part));
    [0.0, 0.5, 1.0].map(speed).into_iter().fold(0.0, f64::max)
}

/// For each half turn, by which factor its present speed may grow, or must fall, to reach the limits
/// of the machine: on the path as played, with its segments halved so often.
fn headroom(plan: &Plan<'_>, depths: &[Depths], observer: &dyn Observer) -> Result<Vec<f64>> {
    let mut all = vec![f64::INFINITY; half_turns(plan.law.end())];
    let mut state = first_state(plan);
    let mut from = 0;
    while from < plan.blocks() {
        stop_if_cancelled(observer)?;
        let range = from..(from + BATCH).min(plan.blocks());
        from = range.end;
        for block in make(plan, range, depths, state.as_mut())? {
            include(plan, &block, &mut all);
        }
    }
    Ok(all)
}

/// The limits that a speed can be asked for. A constant speed has no acceleration and no jerk, and what
/// the rounding of its points leaves of them follows no speed.
fn limits(plan: &Plan<'_>) -> Machine {
    let mut machine = plan.preparation.task.machine;
    if plan.spindle.is_constant() {
        (machine.c.acceleration, machine.c.jerk) = (None, None);
    }
    machine
}

/// Includes the half turns of a block. A segment across the border of two counts for both.
fn include(plan: &Plan<'_>, block: &BlockPoints, all: &mut [f64]) {
    let (machine, points) = (&limits(plan), &block.points);
    let (Some(first), Some(last)) = (points.c.first(), points.c.last()) else {
        return;
    };
    let before = |c: f64| points.c.partition_point(|other| *other < c);
    for half in (first / PI).floor() as usize..(last / PI).ceil() as usize {
        let from = before(PI * half as f64).saturating_sub(1);
        let to = before(PI * (half + 1) as f64).min(points.len() - 1);
        let part = (from..=to).filter_map(|index| points.get(index));
        let part = PathBlock::of(points.shape, part);
        let certain = CertainMotion::of(&part);
        let figures = AxesMotion::of(&part).against(machine, Some(&certain));
        let figures = figures.into_iter();
        let of_limits = figures.map(|figure| figure.speed_factor());
        if let Some(headroom) = all.get_mut(half) {
            *headroom = of_limits.fold(*headroom, f64::min);
        }
    }
}
