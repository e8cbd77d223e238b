//! Makes one lead: as long as its limits ask for, in steps as fine as the part asks for.

use turnpath_core::toolpath::{ControlPoint, PathBlock, SegmentShape};
use turnpath_verify::{AxesMotion, LeadMeter, LeadStretch};

use super::clock::Clock;
use super::join::{Join, Side};
use super::limits::{self, Beyond, LeadSettings, QUINTIC, SPEED_UP};
use super::nodes::{self, MOST_NODES};
use super::phases::Phases;
use super::spline::{self, FEWEST_NODES, Motion};
use super::target::Target;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Fewest revolutions from rest height to the part: the last tenth of a millimetre then takes
/// most of one.
const GENTLE_TURNS: f64 = 2.0;
/// How much longer a phase gets that asks too much of the axes, and how often at the most: 57
/// times as long.
const LONGER: f64 = 1.4;
const LENGTHENINGS: u32 = 12;
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

/// How much longer than at first the phases are.
#[derive(Debug, Clone, Copy)]
struct Longer {
    descent: f64,
    spin: f64,
    drift: f64,
}

impl Longer {
    fn for_those(&mut self, beyond: Beyond) {
        if beyond.c {
            self.spin *= LONGER;
        }
        if beyond.x || beyond.z {
            self.descent *= LONGER;
        }
        if beyond.x {
            self.drift *= LONGER;
        }
    }
}

impl Maker<'_> {
    /// Lays a lead that keeps its limits and clears the part. The join of a lead-in is that of a
    /// cut which begins at once: the lead-in moves it.
    pub fn lay(&self, side: Side, join: &Join) -> Result<Laid> {
        let mut longer = Longer {
            descent: 1.0,
            spin: 1.0,
            drift: 1.0,
        };
        let mut lengthenings = 0;
        loop {
            let (laid, points) = self.clear(side, join, longer)?;
            let motion = AxesMotion::of(&away_from_join(side, &points));
            let following = self.following(&laid, join)?;
            let beyond = self.settings.limits.beyond(&motion, &join.cut, &following);
            if !beyond.any() {
                return Ok(laid);
            }
            if lengthenings == LENGTHENINGS {
                return Err(self.failed(side, asks_too_much(beyond)));
            }
            longer.for_those(beyond);
            lengthenings += 1;
        }
    }

    /// What following the part asks of the axes at the lead's own nodes. The cut as played does
    /// not always say it: its steps may be coarser than the part.
    fn following(&self, laid: &Laid, join: &Join) -> Result<AxesMotion> {
        let phases = laid.phases;
        let sigma = laid.nodes.iter().map(|ticks| self.clock.seconds(*ticks));
        let sigma: Vec<f64> = sigma.take_while(|s| *s <= phases.descent).collect();
        let (plan, rest_z) = (self.plan, self.rest_z);
        let target = Target::new(plan, laid.side, join, phases, rest_z, laid.drift)?;
        let [x, z] = target.on_the_part(&sigma)?;
        Ok(AxesMotion {
            x: limits::of_differences(&sigma, &x),
            z: limits::of_differences(&sigma, &z),
            ..AxesMotion::default()
        })
    }

    /// Halves steps until the lead clears the part, then raises its way until its control points
    /// do.
    fn clear(&self, side: Side, join: &Join, longer: Longer) -> Result<(Laid, PathBlock)> {
        let mut laid = self.first(side, join, longer)?;
        let join = match side {
            Side::In => join.shifted(laid.turns, self.clock.seconds(laid.ticks())),
            Side::Out => *join,
        };
        let tolerance = self.plan.prepared.job.tolerance.interpolation;
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
    fn first(&self, side: Side, join: &Join, longer: Longer) -> Result<Laid> {
        let (limits, speed) = (&self.settings.limits, join.point.vc);
        let down = limits.z.time_for(self.rest_z - join.point.z, QUINTIC);
        let gentle = GENTLE_TURNS * std::f64::consts::TAU / speed;
        let least = Phases {
            descent: longer.descent * down.max(gentle),
            spin: longer.spin * PLAYED * limits.c.time_to_change(speed, SPEED_UP),
            speed,
        };
        let bounded = least.all() * speed < MOST_NODES as f64;
        let too_many = || self.failed(side, format!("it would take {:.3e} s", least.all()));
        if !bounded {
            return Err(too_many());
        }
        let (phases, turns) = match side {
            Side::In => least.on_whole_turns(&self.clock),
            Side::Out => (least.on(&self.clock), 0.0),
        };
        let nodes = nodes::place(&phases, &self.clock).ok_or_else(too_many)?;
        if nodes.len() < FEWEST_NODES {
            let what = "the controller's steps of time are too long for it".to_owned();
            return Err(self.failed(side, what));
        }
        Ok(Laid {
            side,
            phases,
            drift: longer.drift * gentle,
            nodes,
            raised: 0.0,
            turns,
        })
    }

    /// The control points in order of time, that of the join among them.
    pub fn points(&self, laid: &Laid, join: &Join) -> Result<PathBlock> {
        let Laid { side, phases, .. } = *laid;
        let plan = self.plan;
        let target = Target::new(plan, side, join, phases, self.rest_z, laid.drift)?;
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

fn asks_too_much(beyond: Beyond) -> String {
    let axes = [("C", beyond.c), ("X", beyond.x), ("Z", beyond.z)];
    let named: Vec<&str> = axes
        .into_iter()
        .filter_map(|(name, is)| is.then_some(name))
        .collect();
    format!(
        "however slow, it asks more of {} than its limits allow",
        named.join(" and ")
    )
}
