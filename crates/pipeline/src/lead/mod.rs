//! Leads: from rest to the cut, and from the cut to rest.
//!
//! Away from the join a lead keeps to the tool's own locus: Z is a mean of the first touch at C
//! and X and of a height above the whole part, and moves smoothly from the one to the other. Both
//! clear the part, so every mean of them does. C first goes on at the cut's speed until X and Z
//! rest, and then changes its speed. The cubic spline through the nodes takes position, velocity
//! and acceleration of the cut as played, so all three are continuous at every control point.
//! Between nodes near the part a cubic is not the locus. So each lead is played back, and its steps
//! are halved until it clears the part to half the interpolation tolerance, or as well as the cut
//! does at the join.
//!
//! The control point of a join belongs to the cutting section: the lead-in ends with the point
//! before it, and the lead-out begins with the point after it. Leads of straight segments have the
//! same nodes. As in all such paths, their velocity jumps at every node, the ends included.

mod clock;
mod course;
mod height;
mod join;
mod limits;
mod maker;
mod nodes;
mod phases;
mod spline;

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};
use turnpath_verify::{
    AxesMotion, CertainMeter, CertainMotion, LeadBlockFigures, LeadFigures, LeadMeter,
};

use crate::make::{Depths, first_state, make};
use crate::plan::{Plan, Start};
use crate::{PipelineError, Result};

use clock::Clock;
use join::{Join, LeadKind};
pub use limits::{AxisLimits, LeadLimits, LeadSettings};
use maker::Maker;

/// The leads of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leads {
    /// How long the lead-in takes, s.
    pub in_time: f64,
    /// How long the lead-out takes, s.
    pub out_time: f64,
    /// Whole revolutions of C before the cut.
    pub turns_in: f64,
    /// Revolutions of C after the cut.
    pub turns_out: f64,
    /// Z of the nose centre at rest, mm.
    pub rest_z: f64,
    /// Z of the nose centre where it stands highest on the part, mm.
    pub highest_z: f64,
    /// Control points of both leads. The points of the joins belong to the cut.
    pub points: u64,
    /// The figures measured on them.
    pub figures: LeadFigures,
    /// What is certain of the motion of the axes on them.
    pub certain: CertainMotion,
}

impl Leads {
    /// By how much the path rests above the highest point of the part, mm.
    pub fn rest_clearance(&self) -> f64 {
        self.rest_z - self.highest_z
    }
}

/// What the leads of a path are made for: it does not depend on the path's points.
#[derive(Debug, Clone, Copy)]
pub struct LeadTask {
    settings: LeadSettings,
    /// Z of the nose centre where it stands highest on the part, mm.
    highest_z: f64,
}

impl LeadTask {
    /// Looks for the highest place of the part.
    pub fn new(plan: &Plan<'_>, settings: LeadSettings) -> Result<Self> {
        let highest_z = height::highest(plan)?;
        if !highest_z.is_finite() {
            return Err(PipelineError::Lead {
                which: LeadKind::In.name(),
                what: "the nose finds no height anywhere on the part".to_owned(),
            });
        }
        Ok(Self {
            settings,
            highest_z,
        })
    }
}

/// The leads of one path, made one after the other.
pub struct LeadRun {
    task: LeadTask,
    meter: LeadMeter,
    certain: CertainMeter,
    /// The points of the lead-in with the point of the join, once they are made.
    lead_in: Option<PathBlock>,
    turns_in: f64,
}

impl LeadRun {
    /// Makes the lead-in and moves the cut after it. For this the cut's first block is made twice:
    /// first to learn how long the lead-in takes, and again at its new time and angle.
    pub fn begin(plan: &mut Plan<'_>, depths: &[Depths], task: LeadTask) -> Result<Self> {
        let mut run = Self {
            task,
            meter: LeadMeter::default(),
            certain: CertainMeter::default(),
            lead_in: None,
            turns_in: 0.0,
        };
        let (join, _) = first_join(plan, depths)?;
        let layout = run.maker(plan).lay_out(LeadKind::In, &join)?;
        plan.start = Start {
            turns: layout.turns,
            time: layout.ticks(),
        };
        let (join, cut) = first_join(plan, depths)?;
        let maker = run.maker(plan);
        let points = maker.points(&layout, &join)?;
        let figures = maker.measure(&points)?;
        run.turns_in = layout.turns;
        run.append(Section::LeadIn, &points, &figures);
        run.append_cut(&PathBlock::of(plan.segment_shape(), cut));
        run.lead_in = Some(points);
        Ok(run)
    }

    /// Appends the figures of a lead.
    fn append(&mut self, section: Section, points: &PathBlock, figures: &LeadBlockFigures) {
        self.meter.append(figures);
        let certain = self.certain.measure(section, points);
        self.certain.append(&certain);
    }

    /// Appends the end of the cut to which a lead is joined.
    fn append_cut(&mut self, points: &PathBlock) {
        self.meter.append_cut(points);
        let certain = self.certain.measure(Section::Cutting, points);
        self.certain.append(&certain);
    }

    /// The lead-in's points, without that of the join.
    pub fn lead_in(&self) -> PathBlock {
        let mut points = self.lead_in_and_join();
        points.truncate(points.len().saturating_sub(1));
        points
    }

    /// The lead-in with the point of the join.
    pub fn lead_in_and_join(&self) -> PathBlock {
        self.lead_in.clone().unwrap_or_default()
    }

    /// Makes the lead-out after a cut that ends with the points `pair`, and whose last block moves
    /// like `cut`. Gives the points of the lead-out without that of the join, and the leads of the
    /// path.
    pub fn end(
        mut self,
        plan: &Plan<'_>,
        pair: &[ControlPoint; 2],
        cut: AxesMotion,
    ) -> Result<(PathBlock, Leads)> {
        let join = Join::new(plan, LeadKind::Out, pair, cut)?;
        let maker = self.maker(plan);
        let layout = maker.lay_out(LeadKind::Out, &join)?;
        let points = maker.points(&layout, &join)?;
        let figures = maker.measure(&points)?;
        self.append_cut(&PathBlock::of(plan.segment_shape(), *pair));
        self.append(Section::LeadOut, &points, &figures);
        let time = |points: &PathBlock| extent(&points.t);
        let lead_in = self.lead_in.take().unwrap_or_default();
        let leads = Leads {
            in_time: time(&lead_in),
            out_time: time(&points),
            turns_in: self.turns_in,
            turns_out: extent(&points.c) / std::f64::consts::TAU,
            rest_z: self.rest_z(),
            highest_z: self.task.highest_z,
            points: (lead_in.len() + points.len()).saturating_sub(2) as u64,
            figures: self.meter.figures().copied().unwrap_or_default(),
            certain: self.certain.leads().copied().unwrap_or_default(),
        };
        Ok((without_first(&points), leads))
    }

    /// Z of the nose centre at rest, mm.
    fn rest_z(&self) -> f64 {
        self.task.highest_z + self.task.settings.clearance
    }

    fn maker<'a>(&self, plan: &'a Plan<'a>) -> Maker<'a> {
        Maker {
            plan,
            settings: self.task.settings,
            clock: Clock::new(plan.time_steps),
            rest_z: self.rest_z(),
            shape: plan.chain.velocity.strategy.segments(),
        }
    }
}

/// The join at the start of the cut as the plan now has it, and the first two points of the cut.
fn first_join(plan: &Plan<'_>, depths: &[Depths]) -> Result<(Join, [ControlPoint; 2])> {
    let blocks = make(plan, 0..1, depths, first_state(plan).as_mut())?;
    let points = blocks.first().map(|block| &block.points);
    let pair = points.and_then(|points| Some([points.get(0)?, points.get(1)?]));
    let Some((points, pair)) = points.zip(pair) else {
        return Err(PipelineError::Lead {
            which: LeadKind::In.name(),
            what: "the cut has no segment".to_owned(),
        });
    };
    let join = Join::new(plan, LeadKind::In, &pair, AxesMotion::of(points))?;
    Ok((join, pair))
}

/// Last value − first value.
fn extent(values: &[f64]) -> f64 {
    match (values.first(), values.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}

fn without_first(points: &PathBlock) -> PathBlock {
    PathBlock::of(points.shape, points.points().skip(1))
}
