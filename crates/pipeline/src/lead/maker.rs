//! Makes one lead, as long as its limits require and in steps as fine as the part requires.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{ControlPoint, PathBlock, SegmentShape};
use turnpath_verify::{AxesMotion, LeadBlockFigures, LeadMeter};

use super::clock::Clock;
use super::course::Course;
use super::join::{Join, LeadKind};
use super::limits::{self, LeadMotion, LeadSettings, QUINTIC, SPEED_UP, Shares};
use super::nodes::{self, MOST_NODES};
use super::phases::Phases;
use super::spline::{self, FEWEST_NODES, Motion};
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Fewest revolutions from rest height to the part. The last tenth of a millimetre then takes most of
/// one.
const GENTLE_TURNS: f64 = 2.0;
/// How often a lead that exceeds its limits is laid out again at the most.
const TRIALS: u32 = 18;
/// How much longer a phase then becomes.
const LONGER: f64 = 1.4;
/// How much finer steps near the part become at the most. A spline's acceleration is then right to
/// 1e-4 where it was a tenth too large.
const FINEST: u32 = 32;
/// Longest phases, in revolutions at the cut's speed. Limits that require longer ones are a mistake,
/// and the lead does not keep them.
const LONGEST_DESCENT: f64 = 2000.0;
const LONGEST_SPIN: f64 = 20_000.0;
/// Part of X's limits that X may use to come to rest.
const OVERSHOOT_SHARE: f64 = 0.125;
/// A slower lead replaces the best so far where its excess is below this part of the best's.
const IMPROVEMENT: f64 = 0.999;
/// Instants from node to node at which the course itself is examined.
const COURSE_INSTANTS: usize = 4;
/// How often the steps near the part are halved at the most.
const HALVINGS: u32 = 8;
/// Part of the interpolation tolerance by which a lead may come below the first touch between its
/// control points. Where the cut misses its tolerance beside the join, the lead may come as low as
/// the cut.
const BELOW: f64 = 0.5;
/// Most by which control points may come below the first touch, mm: a hundredth of a nanometre.
const POINTS_BELOW: f64 = 1e-8;
/// How much the course is raised for each length by which a control point comes too low. The point
/// beside the join, which the spline places, follows the course by 0.21 of that.
const RAISE: f64 = 5.0;
/// How often the course is raised at the most.
const RAISES: u32 = 8;
/// Segments beside the join to which the limits of the axes do not apply. There the spline goes from
/// what the cut plays to the locus itself, by a quarter of the difference a node, and the
/// accelerations of a cut that plays badly are far from those of the locus.
const TRANSITION: usize = 8;
/// Factor by which a spline through the nodes of the spindle's phase raises the acceleration.
const PLAYED: f64 = 1.01;

/// Makes the leads of a path.
pub struct Maker<'a> {
    pub plan: &'a Plan<'a>,
    pub settings: LeadSettings,
    pub clock: Clock,
    /// Z of the nose centre at rest, mm.
    pub rest_z: f64,
    /// What is played between control points.
    pub shape: SegmentShape,
}

/// The phases and nodes of a lead. They hold for any join that differs by roundings only.
#[derive(Debug, Clone)]
pub struct LeadLayout {
    kind: LeadKind,
    phases: Phases,
    /// How long ρ may overshoot the cut, s.
    overshoot: f64,
    /// From the join to rest, in ticks away from the join.
    nodes: Vec<f64>,
    /// How much higher than the locus the course begins, mm.
    raised: f64,
    /// Whole revolutions of a lead-in.
    pub turns: f64,
}

impl LeadLayout {
    /// How long the lead takes, in ticks.
    pub fn ticks(&self) -> f64 {
        self.nodes.last().copied().unwrap_or_default()
    }
}

/// How much more gently than at first a lead is laid out.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// Factor on the time of the descent.
    descent: f64,
    /// Factor on the time of the spindle's phase.
    spin: f64,
    /// Factor on the time of the overshoot. X still gets the time that it takes to come to rest with
    /// a part of its limits.
    overshoot: f64,
    /// How many times as fine steps near the part are.
    finer: u32,
    /// How many times as fine they may become.
    finest: u32,
    /// The excess before the last trial, if steps were made finer for that trial.
    before_finer: Option<f64>,
}

impl Pace {
    const FIRST: Self = Self {
        descent: 1.0,
        spin: 1.0,
        overshoot: 1.0,
        finer: 1,
        finest: FINEST,
        before_finer: None,
    };

    /// Makes the pace gentler after a lead that used these shares of its limits, on a course that by
    /// itself used those.
    fn soften(&mut self, lead: Shares, course: Shares) {
        let before = self.before_finer.take();
        if before.is_some_and(|before| lead.excess() >= before) {
            // The cut as played is not on the course at its end: short steps join it with a jolt.
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
        // A spline moves the axes more than the course on which its nodes lie; a coarse one most.
        if slides(course) <= 1.0 && self.finer < self.finest {
            self.finer *= 2;
            self.before_finer = Some(lead.excess());
            return;
        }
        self.descent *= LONGER;
        // A shorter overshoot keeps X away from larger slopes.
        self.overshoot /= LONGER;
    }
}

impl Maker<'_> {
    /// Lays out a lead that clears the part and keeps its limits, or exceeds them as little as
    /// possible. The join of a lead-in is that of a cut that begins at once; the lead-in moves it.
    pub fn lay_out(&self, kind: LeadKind, join: &Join) -> Result<LeadLayout> {
        let mut pace = Pace::FIRST;
        let (mut best, mut least) = (None, f64::INFINITY);
        for _ in 0..TRIALS {
            let (layout, points) = match (self.clear(kind, join, pace), &best) {
                (Ok(clear), _) => clear,
                (Err(error), None) => return Err(error),
                // A longer lead may leave the surface, or need too many nodes.
                (Err(_), Some(_)) => break,
            };
            let following = self.following(&layout, join)?;
            let limits = &self.settings.limits;
            let shares = |motion| limits.shares(&motion, &join.cut, &following);
            let of_lead = shares(LeadMotion {
                whole: AxesMotion::of(&points),
                away: AxesMotion::of(&away_from_join(kind, &points)),
            });
            let course = self.course_motion(&layout, join)?;
            if of_lead.largest() <= 1.0 {
                return Ok(layout);
            }
            let longest = layout.phases.descent * join.point.vc >= TAU * LONGEST_DESCENT;
            if best.is_none() || of_lead.excess() < IMPROVEMENT * least {
                (best, least) = (Some(layout), of_lead.excess());
            }
            if longest {
                break;
            }
            pace.soften(
                of_lead,
                shares(LeadMotion {
                    whole: course,
                    away: course,
                }),
            );
        }
        best.ok_or_else(|| self.failed(kind, "no trial was made".to_owned()))
    }

    /// How X and Z move on the course itself near the part, whatever is played between nodes.
    fn course_motion(&self, layout: &LeadLayout, join: &Join) -> Result<AxesMotion> {
        let phases = layout.phases;
        let nodes = layout.nodes.iter();
        let sigma: Vec<f64> = nodes.map(|t| self.clock.seconds(*t)).collect();
        let between = |pair: &[f64]| {
            let (from, step) = (pair[0], (pair[1] - pair[0]) / COURSE_INSTANTS as f64);
            (0..COURSE_INSTANTS).map(move |i| from + step * i as f64)
        };
        let near = sigma.windows(2).filter(|pair| pair[1] <= phases.descent);
        let sigma: Vec<f64> = near.flat_map(between).collect();
        let course = self.course(layout, join)?;
        let positions = course.positions(&sigma, layout.raised)?;
        Ok(AxesMotion {
            x: limits::motion_by_differences(&sigma, &positions.x),
            z: limits::motion_by_differences(&sigma, &positions.z),
            ..AxesMotion::default()
        })
    }

    fn course<'b>(&'b self, layout: &LeadLayout, join: &'b Join) -> Result<Course<'b>> {
        let (kind, phases, overshoot) = (layout.kind, layout.phases, layout.overshoot);
        Course::new(self.plan, kind, join, phases, self.rest_z, overshoot)
    }

    /// How the axes would move at the lead's own nodes if they followed the part. The motion of the
    /// cut as played does not always show it, since its steps may be too coarse for the part.
    fn following(&self, layout: &LeadLayout, join: &Join) -> Result<AxesMotion> {
        let phases = layout.phases;
        let sigma = layout.nodes.iter().map(|ticks| self.clock.seconds(*ticks));
        let sigma: Vec<f64> = sigma.take_while(|s| *s <= phases.descent).collect();
        let [x, z] = self.course(layout, join)?.on_the_part(&sigma)?;
        Ok(AxesMotion {
            x: limits::motion_by_differences(&sigma, &x),
            z: limits::motion_by_differences(&sigma, &z),
            ..AxesMotion::default()
        })
    }

    /// Halves steps until the lead clears the part, then raises its course until its control points
    /// do.
    fn clear(&self, kind: LeadKind, join: &Join, pace: Pace) -> Result<(LeadLayout, PathBlock)> {
        let mut layout = self.first(kind, join, pace)?;
        let join = match kind {
            LeadKind::In => join.shifted(layout.turns, self.clock.seconds(layout.ticks())),
            LeadKind::Out => *join,
        };
        let tolerance = self.plan.preparation.task.tolerance.interpolation;
        // Where the cut itself misses its tolerance, which is reported, its lead may miss it too.
        let below = match join.error > tolerance {
            true => join.error,
            false => BELOW * tolerance,
        };
        let floor = join.above_touch.min(0.0) - below;
        let (mut halvings, mut raises) = (0, 0);
        loop {
            let points = self.points(&layout, &join)?;
            let figures = self.measure(&points)?;
            // The comparison also finds what is no number.
            let clears = |clearance: &f64| *clearance >= floor;
            let mut below: Vec<bool> = figures.per_segment.iter().map(|c| !clears(c)).collect();
            if !below.contains(&true) {
                let lowest = figures.per_start.iter().copied().fold(0.0, f64::min);
                let missing = join.above_touch.min(0.0) - POINTS_BELOW - lowest;
                if missing <= 0.0 || raises == RAISES {
                    return Ok((layout, points));
                }
                layout.raised += RAISE * missing;
                raises += 1;
                continue;
            }
            if halvings == HALVINGS {
                let lowest = &figures.figures;
                let what = format!(
                    "at C = {:.3} deg, X = {:.6} mm it would come {:.3e} mm below the first touch, \
                     however fine its steps",
                    lowest.at_c / turnpath_core::DEG,
                    lowest.at_x,
                    -lowest.clearance
                );
                return Err(self.failed(kind, what));
            }
            if kind == LeadKind::In {
                below.reverse();
            }
            layout.nodes = nodes::halve(&layout.nodes, &below, &self.clock);
            if layout.nodes.len() > MOST_NODES {
                let what = format!("it would take more than {MOST_NODES} points to clear the part");
                return Err(self.failed(kind, what));
            }
            halvings += 1;
        }
    }

    /// Phases as short as the limits allow, and their nodes.
    fn first(&self, kind: LeadKind, join: &Join, pace: Pace) -> Result<LeadLayout> {
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
        let overshoot = limits
            .x
            .time_to_change(join.rho_rate / OVERSHOOT_SHARE, SPEED_UP);
        let too_many = || self.failed(kind, format!("it would take {:.3e} s", least.all()));
        let (phases, turns) = match kind {
            LeadKind::In => least.on_whole_turns(&self.clock),
            LeadKind::Out => (least.on(&self.clock), 0.0),
        };
        let nodes = nodes::place(&phases, &self.clock, pace.finer).ok_or_else(too_many)?;
        if nodes.len() < FEWEST_NODES {
            let what = "the controller's steps of time are too long for it".to_owned();
            return Err(self.failed(kind, what));
        }
        Ok(LeadLayout {
            kind,
            phases,
            overshoot: (pace.overshoot * gentle).max(overshoot),
            nodes,
            raised: 0.0,
            turns,
        })
    }

    /// The control points in order of time, with that of the join.
    pub fn points(&self, layout: &LeadLayout, join: &Join) -> Result<PathBlock> {
        let kind = layout.kind;
        let course = self.course(layout, join)?;
        let at_join = match kind {
            LeadKind::In => layout.ticks(),
            LeadKind::Out => self.clock.nearest(join.point.t),
        };
        let mut nodes = layout.nodes.clone();
        if kind == LeadKind::In {
            nodes.reverse();
        }
        let away: Vec<f64> = nodes
            .iter()
            .map(|ticks| self.clock.seconds(*ticks))
            .collect();
        let t: Vec<f64> = nodes
            .iter()
            .map(|ticks| self.clock.seconds(at_join + kind.sign() * ticks))
            .collect();
        let positions = course.positions(&away, layout.raised)?;
        let rest = [course.rest_c(), course.rest_x, course.rest_z];
        let ends = Ends::new(join, rest);
        let mut points = PathBlock {
            shape: self.shape,
            ..PathBlock::default()
        };
        let [c, x, z] = [positions.c, positions.x, positions.z];
        let mut axes = [c, x, z].into_iter().zip(ends.0).map(|(p, [join, rest])| {
            let (first, last) = match kind {
                LeadKind::In => (rest, join),
                LeadKind::Out => (join, rest),
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
            let slopes = spline::interpolate(t, &mut p, first, last);
            return (p, slopes);
        }
        (p[0], p[end]) = (first.position, last.position);
        let rate = |k: usize| (p[k + 1] - p[k]) / (t[k + 1] - t[k]);
        let rates = (0..=end).map(|k| rate(k.min(end - 1))).collect();
        (p, rates)
    }

    /// Measures a lead against the part.
    pub fn measure(&self, points: &PathBlock) -> Result<LeadBlockFigures> {
        LeadMeter::measure(&self.plan.preparation.touch, points).map_err(PipelineError::Measure)
    }

    fn failed(&self, kind: LeadKind, what: String) -> PipelineError {
        let which = kind.name();
        PipelineError::Lead { which, what }
    }
}

/// The motions of C, X and Z at the join and at rest.
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
            let at_join = Motion {
                position,
                velocity,
                acceleration: join.acceleration[axis],
            };
            let at_rest = Motion {
                position: rest[axis],
                ..Motion::default()
            };
            [at_join, at_rest]
        }))
    }
}

/// The points of a lead without those of the transition.
fn away_from_join(kind: LeadKind, points: &PathBlock) -> PathBlock {
    let skipped = TRANSITION.min(points.len());
    let (from, to) = match kind {
        LeadKind::In => (0, points.len() - skipped),
        LeadKind::Out => (skipped, points.len()),
    };
    let kept = points.points().skip(from).take(to - from);
    PathBlock::of(points.shape, kept)
}
