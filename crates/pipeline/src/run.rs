//! The whole run: law, refinement, then every block made, measured and handed on in order.

use rayon::prelude::*;
use turnpath_core::Servo;
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};
use turnpath_verify::machined::MachinedFigures;
use turnpath_verify::{
    AxesMotion, FirstTouch, Measured, Meter, PathFigures, ServoFigures, ServoMeter, ServoStart,
    ServoStretch,
};

use crate::lead::{LeadRun, LeadSettings, Leads};
use crate::make::{Depths, Made, join, make};
use crate::order::in_order;
use crate::plan::Plan;
use crate::progress::{Progress, Stage};
use crate::refine::{first_state, refine, runs};
use crate::{Chain, PipelineError, Prepared, Result};

/// Blocks that are made at a time: enough for every thread, and few enough that a batch of large
/// blocks (half a million nodes each) stays within some hundred megabytes.
const LARGE_BATCH: usize = 64;
/// Control points that a batch should not exceed much.
const BATCH_POINTS: f64 = 5e5;
/// Blocks that are looked at to expect the count of points.
const LOOKED_AT: usize = 8;

/// Takes the path as it is made: blocks are put into the form of each file in parallel, and taken
/// in order.
pub trait Sink: Sync {
    /// A block in the form of each file.
    fn encode(&self, stretch: &SectionBlock<'_>) -> std::io::Result<Vec<Vec<u8>>>;
    /// The next block in the form of each file, with its count of control points.
    fn take(&mut self, points: usize, encoded: &[Vec<u8>]) -> std::io::Result<()>;
}

/// A block, measured and in the form of each file.
struct Ready {
    measured: Measured,
    own_axes: AxesMotion,
    served: Option<ServoStretch>,
    points: usize,
    sampled: usize,
    encoded: Vec<Vec<u8>>,
}

/// What a run gave.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Control points of the cutting section.
    pub control_points: u64,
    /// Of these, added by refinement.
    pub added_by_refine: u64,
    /// Revolutions of the cutting section.
    pub revolutions: f64,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// What the path as played would cut.
    pub figures: PathFigures,
    /// How the axes move while the law is the feed strategy's own: where the host lets the feed run
    /// out is not in it. `None` where another law took its place.
    pub own_axes: Option<AxesMotion>,
    /// The surface that it would leave; `None` where nothing of the part is cut.
    pub machined: Option<MachinedFigures>,
    /// The leads, where the path has some.
    pub lead: Option<Leads>,
    /// What the servo makes of it, where that is asked.
    pub servo: Option<ServoFigures>,
}

/// What a run will give, without making it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Revolutions.
    pub revolutions: f64,
    /// Time, s.
    pub cutting_time: f64,
    /// Points that the sampler will place, from a few blocks.
    pub control_points: f64,
}

/// How a path is made, besides its chain and job.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Making {
    /// Whether segments whose error exceeds the tolerance are halved.
    pub refine: bool,
    /// Steps of time a second to which the controller rounds: every control point is then put
    /// where the path is at such a step, so that program and path have the same points.
    pub time_steps: Option<f64>,
    /// How the path comes from rest and goes to rest; it begins and ends in motion without.
    pub lead: Option<LeadSettings>,
    /// Whether the path covers the axis on purpose: the cusps there are then residual too.
    pub covers_centre: bool,
    /// How the axes answer, where it is asked what that comes to.
    pub servo: Option<Servo>,
}

/// Makes, measures and hands on the path.
pub fn run(
    chain: &Chain,
    prepared: &Prepared,
    making: Making,
    sink: &mut dyn Sink,
    progress: &dyn Progress,
) -> Result<Outcome> {
    progress.begin(Stage::Law, 1);
    let mut plan = Plan::new(chain, prepared)?;
    plan.time_steps = making.time_steps;
    let batch = batch_size(&plan)?;
    let depths = match making.refine {
        true => refine(&plan, batch, progress)?,
        false => Vec::new(),
    };
    let leads = making
        .lead
        .map(|settings| LeadRun::begin(&mut plan, &depths, settings))
        .transpose()?;
    let meter = Meter::new(prepared.touch.clone()).counting_centre(making.covers_centre);
    let servo = making.servo.as_ref().map(ServoMeter::new);
    let meters = (meter, servo);
    write(&plan, batch, &depths, leads, meters, sink, progress)
}

fn write(
    plan: &Plan<'_>,
    batch: usize,
    depths: &[Depths],
    leads: Option<LeadRun>,
    (meter, mut servo): (Meter, Option<ServoMeter>),
    sink: &mut dyn Sink,
    progress: &dyn Progress,
) -> Result<Outcome> {
    let mut trail = Trail::default();
    if let Some(leads) = &leads {
        if let Some(servo) = &mut servo {
            servo.pass(&leads.lead_in_and_join());
        }
        trail.hand_on(Section::LeadIn, &leads.lead_in(), sink)?;
    }
    let mut taken = Taken::new(meter, servo);
    let blocks: Vec<usize> = (0..plan.blocks()).collect();
    progress.begin(Stage::Write, blocks.len() as u64);
    let (mut held, mut state) = (Vec::new(), first_state(plan));
    for range in runs(&blocks, batch) {
        let mut made = held;
        made.extend(make(plan, range.clone(), depths, state.as_mut())?);
        join(&mut made);
        // The last block waits for the first point of the next one.
        held = made.split_off(made.len() - usize::from(range.end < plan.blocks()));
        taken.take(plan, made, &mut trail, sink)?;
        progress.advance(range.len() as u64);
    }
    let lead = match leads.zip(trail.last_two()) {
        None => None,
        Some((leads, pair)) => {
            let (points, leads) = leads.end(plan, &pair, taken.last_motion)?;
            trail.hand_on(Section::LeadOut, &points, sink)?;
            Some(leads)
        }
    };
    taken.outcome(plan, lead)
}

/// What has been measured of the blocks that were handed on.
struct Taken {
    meter: Meter,
    servo: Option<ServoMeter>,
    points: u64,
    sampled: u64,
    own_axes: AxesMotion,
    /// Of the last block.
    last_motion: AxesMotion,
}

impl Taken {
    fn new(meter: Meter, servo: Option<ServoMeter>) -> Self {
        Self {
            meter,
            servo,
            points: 0,
            sampled: 0,
            own_axes: AxesMotion::default(),
            last_motion: AxesMotion::default(),
        }
    }

    /// Measures blocks in parallel, and hands them on in order.
    fn take(
        &mut self,
        plan: &Plan<'_>,
        made: Vec<Made>,
        trail: &mut Trail,
        sink: &mut dyn Sink,
    ) -> Result<()> {
        let (touch, own) = (&plan.prepared.touch, plan.own_angles());
        let behind: Vec<Behind> = made.iter().map(|made| trail.behind_cut(made)).collect();
        let mut pass = |made: &Made| Some(self.servo.as_mut()?.pass(&made.points));
        let starts: Vec<Option<ServoStart>> = made.iter().map(&mut pass).collect();
        let encoder: &dyn Sink = sink;
        let each = made.into_par_iter().zip(behind).zip(starts);
        let ready = in_order(
            each.map(|((made, behind), start)| ready(touch, made, own, &behind, start, encoder)),
        )?;
        ready
            .into_iter()
            .try_for_each(|block| self.add(block, sink))
    }

    fn add(&mut self, block: Ready, sink: &mut dyn Sink) -> Result<()> {
        let appended = self.meter.append(&block.measured);
        appended.map_err(PipelineError::Measure)?;
        if let (Some(servo), Some(served)) = (&mut self.servo, &block.served) {
            servo.append(served);
        }
        self.points += block.points as u64;
        self.sampled += block.sampled as u64;
        self.own_axes.append(&block.own_axes);
        self.last_motion = block.measured.axes;
        sink.take(block.points, &block.encoded)
            .map_err(PipelineError::Sink)
    }

    fn outcome(self, plan: &Plan<'_>, lead: Option<Leads>) -> Result<Outcome> {
        let revolutions = plan.law.end();
        Ok(Outcome {
            control_points: self.points,
            added_by_refine: self.points - self.sampled,
            revolutions,
            cutting_time: plan.prepared.task.spindle.time_at(revolutions),
            own_axes: plan.own_angles().map(|_| self.own_axes),
            machined: self.meter.machined().map_err(PipelineError::Measure)?,
            figures: self.meter.figures().map_err(PipelineError::Measure)?,
            lead,
            servo: self.servo.map(|servo| *servo.figures()),
        })
    }
}

/// What came before a stretch.
struct Behind {
    /// The last two points, as far as there are any.
    before: Vec<ControlPoint>,
    opens_section: bool,
}

/// What the next stretch comes behind.
#[derive(Default)]
struct Trail {
    tail: Vec<ControlPoint>,
    section: Option<Section>,
}

impl Trail {
    /// What is before the first `own` of these points; the last two of them take their place.
    fn behind(&mut self, section: Section, points: &PathBlock, own: usize) -> Behind {
        let before = self.tail.clone();
        let last = (own.saturating_sub(2)..own).filter_map(|index| points.get(index));
        self.tail.extend(last);
        self.tail.drain(..self.tail.len().saturating_sub(2));
        let opens_section = self.section.replace(section) != Some(section);
        Behind {
            before,
            opens_section,
        }
    }

    fn behind_cut(&mut self, made: &Made) -> Behind {
        self.behind(Section::Cutting, &made.points, made.owner.len())
    }

    /// The last two points so far.
    fn last_two(&self) -> Option<[ControlPoint; 2]> {
        self.tail.as_slice().try_into().ok()
    }

    /// Hands a whole section on.
    fn hand_on(&mut self, section: Section, points: &PathBlock, sink: &mut dyn Sink) -> Result<()> {
        let behind = self.behind(section, points, points.len());
        let stretch = SectionBlock {
            section,
            opens_section: behind.opens_section,
            before: &behind.before,
            points,
        };
        let encoded = sink.encode(&stretch).map_err(PipelineError::Sink)?;
        sink.take(points.len(), &encoded)
            .map_err(PipelineError::Sink)
    }
}

/// Measures a block and puts it into the form of each file, the joint with the next one left out.
fn ready(
    touch: &FirstTouch,
    made: Made,
    own: Option<[f64; 2]>,
    behind: &Behind,
    start: Option<ServoStart>,
    sink: &dyn Sink,
) -> Result<Ready> {
    let measured = Meter::measure(touch, &made.points).map_err(PipelineError::Measure)?;
    let served = start.map(|start| ServoMeter::measure(touch, &start, &made.points));
    let served = served.transpose().map_err(PipelineError::Measure)?;
    let own_axes = own.map_or_else(AxesMotion::default, |angles| {
        AxesMotion::between(&made.points, angles)
    });
    let mut points = made.points;
    points.truncate(made.owner.len());
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: behind.opens_section,
        before: &behind.before,
        points: &points,
    };
    let encoded = sink.encode(&stretch).map_err(PipelineError::Sink)?;
    Ok(Ready {
        measured,
        own_axes,
        served,
        points: points.len(),
        sampled: made.sampled,
        encoded,
    })
}

/// What the chain's law and sampler will give.
pub fn expect(chain: &Chain, prepared: &Prepared) -> Result<Expected> {
    let plan = Plan::new(chain, prepared)?;
    let revolutions = plan.law.end();
    Ok(Expected {
        revolutions,
        cutting_time: plan.prepared.task.spindle.time_at(revolutions),
        control_points: nodes_per_revolution(&plan)? * revolutions + 1.0,
    })
}

fn nodes_per_revolution(plan: &Plan<'_>) -> Result<f64> {
    let every = plan.blocks().div_ceil(LOOKED_AT).max(1);
    let (mut nodes, mut revolutions) = (0.0, 0.0);
    for index in (0..plan.blocks()).step_by(every) {
        let block = plan.revolutions(index);
        nodes += plan.sample(index)?.len() as f64;
        revolutions += block.end - block.start;
    }
    Ok(nodes / revolutions)
}

/// How many blocks to make at a time; it changes memory and speed, never the path.
fn batch_size(plan: &Plan<'_>) -> Result<usize> {
    let per_block = nodes_per_revolution(plan)? * plan.block();
    let fitting = (BATCH_POINTS / per_block.max(1.0)) as usize;
    Ok(fitting.clamp(1, LARGE_BATCH))
}
