//! Steps along one block. Each step is as long as the bound allows.

use std::f64::consts::TAU;
use std::ops::Range;

use super::bound::Bound;
use super::knots::Knot;
use super::samples::Samples;
use crate::kind::{Angle, Flag};
use crate::{DEG, NodeList, Param, Params, Path, Result, Revolutions, SamplerPlan, StrategyError};

/// The part of the tolerance that steps aim at. It lies below refinement's aim of 0.99, so that
/// refinement never halves a correct step because of what samples and rounding miss. It makes a
/// step 0.5 % shorter.
const AIM: f64 = 0.98;
/// The least number of samples within the length of a step.
const LEAST_SAMPLES: f64 = 16.0;
/// The grid becomes coarser again if steps are this many times longer than the grid needs.
const TOO_FINE: f64 = 4.0;
/// [`SHORTEST`] in degrees.
const SHORTEST_DEG: f64 = 0.004;
/// The part of the tolerance that knots within a step may take. A step ends on a knot that might
/// take more.
const KNOTS_SHARE: f64 = 0.1;
/// A step begins at a knot if it begins no further than this before the knot, in revolutions. The
/// sums of the pieces' lengths miss the start of a block by their rounding. The shortest step is
/// 10,000 times as long.
const SAME_POSITION: f64 = 1e-9;
/// A node that lies closer to the block's end than this part of its step is left out.
const SLACK: f64 = 1e-3;
/// Steps whose largest samples are evaluated together.
const AHEAD: usize = 32;

/// Steps that are as long as the interpolation tolerance allows on the played path. This is the
/// core of the samplers that use the error of a cubic Hermite segment.
///
/// Each step is as long as ε ≥ L⁴/384 max|φ⁗| allows over the whole step, with φ⁗ = Z⁗ − ∂Z/∂X·X⁗
/// of the tool centre along the true spiral. X's own error stays below a part of the distance
/// between passes. See [`Bound`] for steps across knots of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Largest step, rad.
    pub max_step: f64,
    /// Part of the distance between neighbouring passes that X's own interpolation error may take.
    /// Two passes may err in opposite directions, and a cusp grows with the square of their
    /// distance. So the cusp grows by at most four times this part of itself, or of the residual where passes
    /// lie closer than [`LEAST_PITCH`](super::LEAST_PITCH).
    pub feed_part: f64,
}

/// The shortest step, rad: 90,000 points on a revolution. A surface that needs shorter steps is not
/// smooth.
pub const SHORTEST: f64 = SHORTEST_DEG * DEG;

/// The parameter `max_step` of the samplers that look for the longest step. The default is 45 deg,
/// and the limit is 90 deg.
pub const MAX_STEP: Param<Angle> = Param::angle("max_step", "largest angle step")
    .default(45.0 * DEG)
    .min(SHORTEST)
    .max(90.0 * DEG);

/// The part of the distance between neighbouring passes that X's own interpolation error may take
/// where X moves within the turn. The cusp grows by 4e-3 of itself or of the residual at the most, and refinement
/// holds what then exceeds the residual. With a tenth of this part, AST-5 with normal compensation
/// takes 1.70 times as many points for 0.1 nm less.
pub const FEED_PART: f64 = 1e-3;

/// The parameter `wander` of samplers with [`MAX_STEP`].
pub const WANDER: Param<Flag> = Param::flag(
    "wander",
    "whether steps that are as long as max_step fall on other angles every turn",
)
.default(true);

/// With `wander`, so many turns take one step more: 513 steps of 45 deg in place of 512, with the
/// last of them a little shorter. So their nodes come round once, and what their angles leave cancels
/// over these turns. Where the largest step decides, that is 0.2 % more points with steps of 45 deg,
/// and 0.4 % with 90 deg.
const WANDERING_TURNS: f64 = 64.0;

/// The largest step of a strategy that declares [`MAX_STEP`] and [`WANDER`], rad.
pub fn largest_step(max_step: f64, wander: bool) -> f64 {
    let steps = WANDERING_TURNS * TAU / max_step;
    match wander {
        true => max_step * (1.0 - (steps + 2.0).recip()),
        false => max_step,
    }
}

impl Steps {
    /// The steps of a strategy that declares [`MAX_STEP`].
    pub fn new(params: &Params, feed_part: f64) -> Self {
        Self {
            max_step: params.get(MAX_STEP),
            feed_part,
        }
    }
}

impl SamplerPlan for Steps {
    /// Appends the nodes of `block`.
    ///
    /// # Errors
    /// If the path has no 4th derivative, or needs steps below [`SHORTEST`].
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        if let Ok(Some(placed)) = self.walk(path, block, true) {
            placed.into_iter().for_each(|n| nodes.push(n));
            return Ok(());
        }
        let placed = self.walk(path, block, false)?;
        placed.into_iter().flatten().for_each(|n| nodes.push(n));
        Ok(())
    }
}

impl Steps {
    /// The nodes of `block`. `None` after the first step of which an estimate does not hold: then all samples have
    /// to be evaluated.
    fn walk(
        &self,
        path: &Path<'_>,
        block: Revolutions,
        estimates: bool,
    ) -> Result<Option<Vec<f64>>> {
        let mut walk = Walk::new(path, block, self, estimates)?;
        let (mut n, mut nodes) = (block.start, Vec::new());
        while n < block.end {
            nodes.push(n);
            let next = walk.step_from(n)?;
            if !walk.samples.estimates_hold() {
                return Ok(None);
            }
            n = if block.end - next < SLACK * (next - n) {
                block.end
            } else {
                next
            };
        }
        Ok(Some(nodes))
    }
}

/// A walk along one block.
struct Walk<'a> {
    samples: Samples<'a>,
    knots: Vec<Knot>,
    next_knot: usize,
    end: f64,
    max_step: f64,
    allowed: f64,
    /// Whether a step was made on the present grid.
    grid_suits: bool,
    /// Room for numbers of samples.
    rivals: Vec<usize>,
}

/// One step.
struct Step {
    /// End of the step, in revolutions.
    end: f64,
    /// What the step's error bound is computed from. For a step that the limit ends on the coarsest grid, it may be made
    /// from upper limits of samples.
    bound: Bound,
}

impl<'a> Walk<'a> {
    fn new(path: &Path<'a>, block: Revolutions, steps: &Steps, estimates: bool) -> Result<Self> {
        let allowed = AIM * path.task.tolerance.interpolation;
        let mut samples = Samples::new(
            path,
            block,
            (steps.max_step, steps.feed_part),
            allowed,
            estimates,
        );
        let knots = samples.knots()?;
        Ok(Self {
            samples,
            knots,
            next_knot: 0,
            end: block.end,
            max_step: steps.max_step,
            allowed,
            grid_suits: false,
            rivals: Vec::new(),
        })
    }

    /// The end of the step from `n`, on a grid as fine as the step needs.
    fn step_from(&mut self, n: f64) -> Result<f64> {
        while self
            .knots
            .get(self.next_knot)
            .is_some_and(|knot| knot.n <= n + SAME_POSITION)
        {
            self.next_knot += 1;
        }
        loop {
            let step = self.longest(n)?;
            let local = self.samples.clock().speed(n);
            let natural = step.bound.natural_length(self.allowed) * local;
            if natural < SHORTEST {
                return Err(too_short(n, natural));
            }
            let looks = natural / self.samples.spacing();
            if looks < LEAST_SAMPLES {
                self.rescale(0.5);
                continue;
            }
            if looks > TOO_FINE * LEAST_SAMPLES && !self.samples.is_coarsest() {
                self.rescale(2.0);
            } else {
                self.grid_suits = true;
            }
            return Ok(step.end);
        }
    }

    fn rescale(&mut self, factor: f64) {
        self.samples.rescale(factor);
        self.grid_suits = false;
    }

    /// The longest step from `n` on the present grid. The walk goes from mark to mark, where a mark
    /// is a sample or a knot, until the error reaches the bound. Samples count with their upper limits. Where
    /// the error reaches the bound with these, the samples that may be the largest are evaluated.
    fn longest(&mut self, n: f64) -> Result<Step> {
        let limit = (n + self.max_step / TAU).min(self.end);
        let clock = self.samples.clock();
        let length = |to: f64| clock.length(n, to);
        let (first, mut knot) = (self.samples.begin(n), self.next_knot);
        let mut sample = first;
        let mut at_knots: f64 = 0.0;
        let mut bound = Bound {
            fourth: self.samples.estimate(sample)?.upper,
            ..Bound::default()
        };
        let mut reached = n;
        sample += 1;
        loop {
            let place = self.samples.position(sample);
            let crossed = self.knots.get(knot).copied().filter(|knot| knot.n <= place);
            let seen = first..sample + usize::from(crossed.is_none());
            let (mark, fourth) = match crossed {
                Some(knot) => {
                    at_knots = at_knots.max(knot.before);
                    (knot.n, knot.before)
                }
                None => (place, self.samples.estimate(sample)?.upper),
            };
            bound.fourth = bound.fourth.max(fourth);
            let to = mark.min(limit);
            if bound.error(length(to)) > self.allowed {
                bound.fourth = self.largest(n, seen.clone(), at_knots)?;
            }
            if bound.error(length(to)) > self.allowed {
                let shorter = length(reached);
                let length = bound.length_between(self.allowed, shorter, length(to));
                let end = if length > shorter {
                    clock.end(n, length)
                } else {
                    reached
                };
                return Ok(Step { end, bound });
            }
            if to >= limit {
                if !self.suits_coarsest_grid(&bound, clock.speed(n)) {
                    bound.fourth = self.largest(n, seen, at_knots)?;
                }
                return Ok(Step { end: limit, bound });
            }
            reached = to;
            let Some(crossed) = crossed else {
                sample += 1;
                continue;
            };
            bound.fourth = self.largest(n, seen, at_knots)?;
            if self.is_hard(&crossed, &bound, length(limit)) {
                return Ok(Step { end: to, bound });
            }
            at_knots = at_knots.max(crossed.after);
            bound.fourth = bound.fourth.max(crossed.after);
            bound.jumps = bound.jumps.and(crossed.jumps);
            knot += 1;
        }
    }

    /// Whether the step needs no finer grid than the coarsest, also with upper limits, and the grid is that one.
    fn suits_coarsest_grid(&self, bound: &Bound, speed: f64) -> bool {
        let natural = bound.natural_length(self.allowed) * speed;
        self.samples.is_coarsest() && natural >= LEAST_SAMPLES * self.samples.spacing()
    }

    /// The largest of these samples and `floor`, exactly. The step begins at `n`.
    fn largest(&mut self, n: f64, samples: Range<usize>, floor: f64) -> Result<f64> {
        let mut rivals = std::mem::take(&mut self.rivals);
        rivals.clear();
        self.samples.add_rivals(samples.clone(), floor, &mut rivals);
        if !rivals.is_empty() {
            if self.grid_suits {
                self.foresee(n, &mut rivals);
            }
            rivals.sort_unstable();
            rivals.dedup();
            self.samples.make_exact(&rivals)?;
        }
        self.rivals = rivals;
        Ok(self.samples.exact(samples).fold(floor, f64::max))
    }

    /// Adds what the next steps will ask for, as far as estimates can tell.
    fn foresee(&self, n: f64, rivals: &mut Vec<usize>) {
        let mut from = n;
        for _ in 0..AHEAD {
            let Some((end, samples)) = self.likely_step(from) else {
                return;
            };
            self.samples.add_rivals(samples, 0.0, rivals);
            from = end;
        }
    }

    /// The end of the step from `n` and the samples that decide about it, with knots left out. `None` if
    /// they are samples of which nothing is known, or reach the block's end.
    fn likely_step(&self, n: f64) -> Option<(f64, Range<usize>)> {
        let first = self.samples.at_or_before(n);
        let clock = self.samples.clock();
        let mut bound = Bound::default();
        for sample in first.. {
            bound.fourth = bound.fourth.max(self.samples.known(sample)?.middle());
            let to = self.samples.position(sample);
            let length = clock.length(n, to);
            if to >= self.end {
                return None;
            }
            if length > self.max_step {
                return Some((n + self.max_step / TAU, first..first));
            }
            if sample > first && bound.error(length) > self.allowed {
                let natural = bound.natural_length(self.allowed);
                return Some((clock.end(n, natural.min(length)), first..sample + 1));
            }
        }
        None
    }
}

impl Walk<'_> {
    /// Whether the jumps of a knot could take more than their share on a step across it.
    fn is_hard(&self, knot: &Knot, bound: &Bound, limit: f64) -> bool {
        let jumps = Bound {
            fourth: 0.0,
            jumps: bound.jumps.and(knot.jumps),
        };
        let longest = bound.natural_length(self.allowed).min(limit);
        jumps.error(longest) > KNOTS_SHARE * self.allowed
    }
}

fn too_short(n: f64, natural: f64) -> StrategyError {
    // The recipe asks for it: surface, tool and tolerance together.
    MAX_STEP.refused(format!(
        "the tolerance needs steps of {:.2e} deg at C = {:.3} deg, but the shortest \
         allowed step is {SHORTEST_DEG} deg: the tool centre's path is not smooth there; choose a larger \
         interpolation tolerance, a smaller tool, or another sampler",
        natural / DEG,
        360.0 * n
    ))
}
