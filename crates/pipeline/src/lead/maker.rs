//! Makes one lead: as long as its limits ask for, in steps as fine as the part asks for.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{ControlPoint, PathBlock, SegmentShape};
use turnpath_verify::{AxesMotion, LeadMeter, LeadStretch};

use super::clock::Clock;
use super::join::{Join, Side};
use super::limits::{self, LeadMotion, LeadSettings, QUINTIC, SPEED_UP, Shares};
use super::nodes;
use super::phases::Phases;
use super::spline::{self, FEWEST_NODES, Motion};
use super::target::Target;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Fewest revolutions from rest height to the part: the last tenth of a millimetre then takes
/// most of one.
const GENTLE_TURNS: f64 = 2.0;
/// How often a lead that asks too much of the axes is laid anew at the most.
const TRIALS: u32 = 18;
/// How much longer a phase then gets.
const LONGER: f64 = 1.4;
/// How much finer steps near the part get at the most: a spline's acceleration is then right to
/// 1e-4 where it was a tenth too large.
const FINEST: u32 = 32;
/// Longest phases, in revolutions at the cut's speed: longer ones come of limits that are a mistake,
/// and the lead then does not keep them.
const LONGEST_DESCENT: f64 = 2000.0;
const LONGEST_SPIN: f64 = 20_000.0;
/// Part of X's limits that its coming to rest may take.
const DRIFTING: f64 = 0.125;
/// A slower lead is worth it where it takes this much less of its limits.
const WORTH_IT: f64 = 0.999;
/// Instants from node to node at which the way itself is looked at.
const FINER_LOOK: usize = 4;
/// How often the steps near the part are halved at the most.
const HALVINGS: u32 = 8;
/// Part of the interpolation tolerance by which a lead may come below the first touch between
/// its control points; by as much as the cut where that misses its own beside the join.
const BELOW: f64 = 0.5;
/// Control points come below the first touch by no more than this, mm: a hundredth of a nanometre.
const POINTS_BELOW: f64 = 1e-8;
/// How much higher the way is laid for each length by which a control point comes too low: the
/// point beside the join, which the spline places, follows it by 0.21.
const RAISE: f64 = 5.0;
/// How often it is raised at the most.
const RAISES: u32 = 8;
/// Segments beside the join of which the axes' limits are not asked: there a spline gets from what
/// the cut plays to the locus itself, by a quarter of it a node, and a cut that plays badly has
/// accelerations that are far from the locus'.
const TRANSITION: usize = 8;
/// What a spline through the nodes of the spindle's phase adds to its acceleration.
const PLAYED: f64 = 1.01;

/// What all leads of a path have in common.
pub struct Maker<'a> {
    pub plan: &'a Plan<'a>,
    pub settings: LeadSettings,
    pub clock: Clock,
    /// Z of the nose centre at rest, mm.
    pub rest_z: f64,
    /// What is played between control points.
    pub shape: SegmentShape,
}

/// A lead's phases and nodes, which hold for any join that differs by roundings alone.
#[derive(Debug, Clone)]
pub struct Laid {
    side: Side,
    phases: Phases,
    /// How long X may drift on, s.
    drift: f64,
    /// From the join to rest, in ticks away from the join.
    nodes: Vec<f64>,
    /// How much higher than the locus its way begins, mm.
    raised: f64,
    /// Whole revolutions of a lead-in.
    pub turns: f64,
}

impl Laid {
    /// How long the lead takes, in ticks.
    pub fn ticks(&self) -> f64 {
        self.nodes.last().copied().unwrap_or_default()
    }
}

/// How much more gently than at first a lead is laid.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// Times as long.
    descent: f64,
    /// Times as long.
    spin: f64,
    /// Times as long, but no shorter than X takes to come to rest with a part of its limits.
    drift: f64,
    /// Steps near the part, times as fine.
    finer: u32,
    /// As fine as they may get.
    finest: u32,
    /// What was taken before steps were made finer the last time, if that was just now.
    before_finer: Option<f64>,
}

impl Pace {
    const FIRST: Self = Self {
        descent: 1.0,
        spin: 1.0,
        drift: 1.0,
        finer: 1,
        finest: FINEST,
        before_finer: None,
    };

    /// For a lead that takes these shares of its limits, on a way that takes those by itself.
    fn gentler(&mut self, lead: Shares, way: Shares) {
        let before = self.before_finer.take();
        if before.is_some_and(|before| lead.beyond() >= before) {
            // What the cut plays at its end is not the way: short steps get there with a jolt.
            self.finer /= 2;
            self.finest = self.finer;
        }
        if lead.c.largest() > 1.0 {
            self.spin *= LONGER;
        }
        let slides = |of: Shares| of.x.largest().max(of.z.largest());
        if slides(lead) <= 1.0 {
            return;
        }
        // Splines ask for more than the way on which their nodes lie, coarse ones for most.
        if slides(way) <= 1.0 && self.finer < self.finest {
            self.finer *= 2;
            self.before_finer = Some(lead.beyond());
            return;
        }
        self.descent *= LONGER;
        // Where X goes on less, it comes less to where slopes are steeper.
        self.drift /= LONGER;
    }
}

impl Maker<'_> {
    /// Lays a lead that clears the part and keeps its limits, or comes as near to them as one can.
    /// The join of a lead-in is that of a cut which begins at once: the lead-in moves it.
    pub fn lay(&self, side: Side, join: &Join) -> Result<Laid> {
        let mut pace = Pace::FIRST;
        let (mut best, mut least) = (None, f64::INFINITY);
        for _ in 0..TRIALS {
            let (laid, points) = match (self.clear(side, join, pace), &best) {
                (Ok(clear), _) => clear,
                (Err(error), None) => return Err(error),
                // Longer ones may find no place, or no room.
                (Err(_), Some(_)) => break,
            };
            let following = self.following(&laid, join)?;
            let limits = &self.settings.limits;
            let shares = |motion| limits.shares(&motion, &join.cut, &following);
            let taken = shares(LeadMotion {
                whole: AxesMotion::of(&points),
                away: AxesMotion::of(&away_from_join(side, &points)),
            });
            let way = self.way(&laid, join)?;
            if taken.largest() <= 1.0 {
                return Ok(laid);
            }
            let longest = laid.phases.descent * join.point.vc >= TAU * LONGEST_DESCENT;
            if best.is_none() || taken.beyond() < WORTH_IT * least {
                (best, least) = (Some(laid), taken.beyond());
            }
            if longest {
                break;
            }
            pace.gentler(
                taken,
                shares(LeadMotion {
                    whole: way,
                    away: way,
                }),
            );
        }
        best.ok_or_else(|| self.failed(side, "no trial was made".to_owned()))
    }

    /// What the way of the lead asks of X and Z near the part, whatever is played between nodes.
    fn way(&self, laid: &Laid, join: &Join) -> Result<AxesMotion> {
        let phases = laid.phases;
        let sigma: Vec<f64> = laid.nodes.iter().map(|t| self.clock.seconds(*t)).collect();
        let between = |pair: &[f64]| {
            let (from, step) = (pair[0], (pair[1] - pair[0]) / FINER_LOOK as f64);
            (0..FINER_LOOK).map(move |i| from + step * i as f64)
        };
        let near = sigma.windows(2).filter(|pair| pair[1] <= phases.descent);
        let sigma: Vec<f64> = near.flat_map(between).collect();
        let target = self.target(laid, join)?;
        let places = target.places(&sigma, laid.raised)?;
        Ok(AxesMotion {
            x: limits::of_differences(&sigma, &places.x),
            z: limits::of_differences(&sigma, &places.z),
            ..AxesMotion::default()
        })
    }

    fn target<'b>(&'b self, laid: &Laid, join: &'b Join) -> Result<Target<'b>> {
        let (side, phases) = (laid.side, laid.phases);
        Target::new(self.plan, side, join, phases, self.rest_z, laid.drift)
    }

    /// What following the part asks of the axes at the lead's own nodes. The cut as played does
    /// not always say it: its steps may be coarser than the part.
    fn following(&self, laid: &Laid, join: &Join) -> Result<AxesMotion> {
        let phases = laid.phases;
        let sigma = laid.nodes.iter().map(|ticks| self.clock.seconds(*ticks));
        let sigma: Vec<f64> = sigma.take_while(|s| *s <= phases.descent).collect();
        let target = self.target(laid, join)?;
        let [x, z] = target.on_the_part(&sigma)?;
        Ok(AxesMotion {
            x: limits::of_differences(&sigma, &x),
            z: limits::of_differences(&sigma, &z),
            ..AxesMotion::default()
        })
    }

    /// Halves steps until the lead clears the part, then raises its way until its control points
    /// do.
    fn clear(&self, side: Side, join: &Join, pace: Pace) -> Result<(Laid, PathBlock)> {
        let mut laid = self.first(side, join, pace)?;
        let join = match side {
            Side::In => join.shifted(laid.turns, self.clock.seconds(laid.ticks())),
            Side::Out => *join,
        };
        let tolerance = self.plan.prepared.task.tolerance.interpolation;
        // Where the cut itself misses its tolerance, which is told, its lead may do so as well.
        let below = match join.error > tolerance {
            true => join.error,
            false => BELOW * tolerance,
        };
        let floor = join.above_touch.min(0.0) - below;
        let (mut halvings, mut raises) = (0, 0);
        loop {
            let points = self.points(&laid, &join)?;
            let stretch = self.measure(&points)?;
            // A comparison that also finds what is no number.
            let clears = |clearance: &f64| *clearance >= floor;
            let mut below: Vec<bool> = stretch.per_segment.iter().map(|c| !clears(c)).collect();
            if !below.contains(&true) {
                let lowest = stretch.per_start.iter().copied().fold(0.0, f64::min);
                let missing = join.above_touch.min(0.0) - POINTS_BELOW - lowest;
                if missing <= 0.0 || raises == RAISES {
                    return Ok((laid, points));
                }
                laid.raised += RAISE * missing;
                raises += 1;
                continue;
            }
            if halvings == HALVINGS {
                let figures = &stretch.figures;
                let what = format!(
                    "at C = {:.3} deg, X = {:.6} mm it would come {:.3e} mm below the first touch, \
                     however fine its steps",
                    figures.at_c / turnpath_core::DEG,
                    figures.at_x,
                    -figures.clearance
                );
                return Err(self.failed(side, what));
            }
            if side == Side::In {
                below.reverse();
            }
            laid.nodes = nodes::halve(&laid.nodes, &below, &self.clock);
            halvings += 1;
        }
    }

    /// Phases as short as the limits allow, and their nodes.
    fn first(&self, side: Side, join: &Join, pace: Pace) -> Result<Laid> {
        let (limits, speed) = (&self.settings.limits, join.point.vc);
        let down = limits.z.time_for(self.rest_z - join.point.z, QUINTIC);
        let gentle = GENTLE_TURNS * TAU / speed;
        let turn = TAU / speed;
        let spin = pace.spin * PLAYED * limits.c.time_to_change(speed, SPEED_UP);
        let least = Phases {
            descent: (pace.descent * down.max(gentle)).min(LONGEST_DESCENT * turn),
            spin: spin.min(LONGEST_SPIN * turn),
            speed,
        };
        let drift = limits.x.time_to_change(join.rho_rate / DRIFTING, SPEED_UP);
        let too_many = || self.failed(side, format!("it would take {:.3e} s", least.all()));
        let (phases, turns) = match side {
            Side::In => least.on_whole_turns(&self.clock),
            Side::Out => (least.on(&self.clock), 0.0),
        };
        let nodes = nodes::place(&phases, &self.clock, pace.finer).ok_or_else(too_many)?;
        if nodes.len() < FEWEST_NODES {
            let what = "the controller's steps of time are too long for it".to_owned();
            return Err(self.failed(side, what));
        }
        Ok(Laid {
            side,
            phases,
            drift: (pace.drift * gentle).max(drift),
            nodes,
            raised: 0.0,
            turns,
        })
    }

    /// The control points in order of time, that of the join among them.
    pub fn points(&self, laid: &Laid, join: &Join) -> Result<PathBlock> {
        let side = laid.side;
        let target = self.target(laid, join)?;
        let joined = match side {
            Side::In => laid.ticks(),
            Side::Out => self.clock.nearest(join.point.t),
        };
        let mut nodes = laid.nodes.clone();
        if side == Side::In {
            nodes.reverse();
        }
        let away: Vec<f64> = nodes
            .iter()
            .map(|ticks| self.clock.seconds(*ticks))
            .collect();
        let t: Vec<f64> = nodes
            .iter()
            .map(|ticks| self.clock.seconds(joined + side.sign() * ticks))
            .collect();
        let places = target.places(&away, laid.raised)?;
        let rest = [target.rest_c(), target.rest_x, target.rest_z];
        let ends = Ends::new(join, rest);
        let mut points = PathBlock {
            shape: self.shape,
            ..PathBlock::default()
        };
        let [c, x, z] = [places.c, places.x, places.z];
        let mut axes = [c, x, z].into_iter().zip(ends.0).map(|(p, [join, rest])| {
            let (first, last) = match side {
                Side::In => (rest, join),
                Side::Out => (join, rest),
            };
            self.axis(&t, p, first, last)
        });
        if let (Some((c, vc)), Some((x, vx)), Some((z, vz))) =
            (axes.next(), axes.next(), axes.next())
        {
            (points.c, points.x, points.z) = (c, x, z);
            (points.vc, points.vx, points.vz) = (vc, vx, vz);
        }
        points.t = t;
        Ok(points)
    }

    /// Positions and velocities of one axis at the nodes.
    fn axis(
        &self,
        t: &[f64],
        mut p: Vec<f64>,
        first: Motion,
        last: Motion,
    ) -> (Vec<f64>, Vec<f64>) {
        let end = p.len() - 1;
        if self.shape == SegmentShape::Cubic {
            let slopes = spline::join(t, &mut p, first, last);
            return (p, slopes);
        }
        (p[0], p[end]) = (first.position, last.position);
        let rate = |k: usize| (p[k + 1] - p[k]) / (t[k + 1] - t[k]);
        let rates = (0..=end).map(|k| rate(k.min(end - 1))).collect();
        (p, rates)
    }

    /// Measures a lead against the part.
    pub fn measure(&self, points: &PathBlock) -> Result<LeadStretch> {
        LeadMeter::measure(&self.plan.prepared.touch, points).map_err(PipelineError::Measure)
    }

    fn failed(&self, side: Side, what: String) -> PipelineError {
        let which = side.name();
        PipelineError::Lead { which, what }
    }
}

/// What C, X and Z do at the join and at rest.
struct Ends([[Motion; 2]; 3]);

impl Ends {
    fn new(join: &Join, rest: [f64; 3]) -> Self {
        let ControlPoint {
            c,
            x,
            z,
            vc,
            vx,
            vz,
            ..
        } = join.point;
        let moving = [(c, vc), (x, vx), (z, vz)];
        Self(std::array::from_fn(|axis| {
            let (position, velocity) = moving[axis];
            let joined = Motion {
                position,
                velocity,
                acceleration: join.acceleration[axis],
            };
            let resting = Motion {
                position: rest[axis],
                ..Motion::default()
            };
            [joined, resting]
        }))
    }
}

/// The points of a lead without those of the transition.
fn away_from_join(side: Side, points: &PathBlock) -> PathBlock {
    let skipped = TRANSITION.min(points.len());
    let mut rest = PathBlock {
        shape: points.shape,
        ..PathBlock::default()
    };
    let (from, to) = match side {
        Side::In => (0, points.len() - skipped),
        Side::Out => (skipped, points.len()),
    };
    let kept = points.points().skip(from).take(to - from);
    kept.for_each(|point| rest.push(point));
    rest
}
