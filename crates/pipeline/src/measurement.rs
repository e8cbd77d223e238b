//! What a run measures on the cutting section, and the result that it gives.

use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_verify::machined::{MachinedFigures, SurfaceExtremes};
use turnpath_verify::{
    AxesMotion, BlockFigures, BlockPlayback, CertainBlock, CertainMeter, CertainMotion, Meter,
    PathFigures, PathSketch, Rounding, ServoBlockFigures, ServoFigures, ServoMeter, ServoStart,
};

use crate::feed_cap::{FeedCap, feed_cap};
use crate::lead::Leads;
use crate::make::BlockPoints;
use crate::options::PathOptions;
use crate::plan::Plan;
use crate::{PipelineError, Preparation, Result};

/// The result of a run.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Control points of the cutting section.
    pub control_points: u64,
    /// How many of these refinement added.
    pub added_by_refine: u64,
    /// Revolutions of the cutting section.
    pub revolutions: f64,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// What the path as played would cut.
    pub figures: PathFigures,
    /// How the axes move while the law is the feed strategy's own. The ends, where the host lets
    /// the feed run out, are not included. `None` where another law took the place of the
    /// strategy's.
    pub own_axes: Option<AxesMotion>,
    /// What is certain of the motion of the axes, where the machine has limits.
    pub certain: Option<CertainMotion>,
    /// The surface that the path would leave; `None` where it cuts nothing of the part.
    pub machined: Option<MachinedFigures>,
    /// The form of that surface, where [`PathOptions::form`](crate::PathOptions::form) asks for it.
    pub form: Option<SurfaceExtremes>,
    /// Where the reach of the nose sets the feed; `None` where it does so nowhere.
    pub feed_cap: Option<FeedCap>,
    /// The leads, where the path has some.
    pub lead: Option<Leads>,
    /// The predicted following error, where [`PathOptions::servo`](crate::PathOptions::servo) is
    /// given.
    pub servo: Option<ServoFigures>,
    /// What pictures of the path need, where [`PathOptions::sketch`](crate::PathOptions::sketch) asks
    /// for it.
    pub sketch: Option<PathSketch>,
}

/// What is measured on the cutting section, block by block.
pub struct Measurement {
    meter: Meter,
    servo: Option<ServoMeter>,
    points: u64,
    placed: u64,
    own_axes: AxesMotion,
    certain: Option<CertainMeter>,
    sketch: bool,
}

/// What is measured on one block.
pub struct BlockMeasurement {
    /// What it would cut, and how the axes move in it.
    pub figures: BlockFigures,
    servo: Option<ServoBlockFigures>,
    own_axes: AxesMotion,
    certain: Option<CertainBlock>,
    points: usize,
    placed: usize,
}

impl Measurement {
    /// Nothing measured yet.
    pub fn new(preparation: &Preparation, options: &PathOptions) -> Self {
        let meter = Meter::new(preparation.touch.clone());
        Self {
            meter: meter
                .counting_centre(options.covers_centre)
                .with_form(options.form),
            servo: options.servo.as_ref().map(ServoMeter::new),
            points: 0,
            placed: 0,
            own_axes: AxesMotion::default(),
            certain: preparation
                .task
                .machine
                .has_limits()
                .then(CertainMeter::default),
            sketch: options.sketch,
        }
    }

    /// Lets the servos follow the next points; gives where they were before, with a model of them.
    pub fn advance(&mut self, points: &PathBlock) -> Option<ServoStart> {
        Some(self.servo.as_mut()?.advance(points))
    }

    /// Appends the path's next block.
    pub fn append(&mut self, block: BlockMeasurement) -> Result<()> {
        let appended = self.meter.append(block.figures);
        appended.map_err(PipelineError::Measure)?;
        if let (Some(meter), Some(block)) = (&mut self.servo, &block.servo) {
            meter.append(block);
        }
        self.points += block.points as u64;
        self.placed += block.placed as u64;
        self.own_axes.append(&block.own_axes);
        if let (Some(meter), Some(block)) = (&mut self.certain, &block.certain) {
            meter.append(block);
        }
        Ok(())
    }

    /// Whether pictures are asked for.
    pub fn keeps_sketch(&self) -> bool {
        self.sketch
    }

    /// The result of the run.
    pub fn outcome(self, plan: &Plan<'_>, lead: Option<Leads>) -> Result<Outcome> {
        let revolutions = plan.law.end();
        let sketch = self.sketch.then(|| self.meter.sketch());
        Ok(Outcome {
            control_points: self.points,
            added_by_refine: self.points - self.placed,
            revolutions,
            cutting_time: plan.spindle.time_at(revolutions),
            own_axes: plan.own_angles().map(|_| self.own_axes),
            certain: self.certain.and_then(|meter| meter.cut().copied()),
            machined: self.meter.machined().map_err(PipelineError::Measure)?,
            form: self.meter.form().map_err(PipelineError::Measure)?,
            figures: self.meter.figures().map_err(PipelineError::Measure)?,
            feed_cap: feed_cap(plan.preparation, &plan.law)?,
            lead,
            sketch: sketch.transpose().map_err(PipelineError::Measure)?,
            servo: self.servo.map(|servo| *servo.figures()),
        })
    }
}

impl BlockMeasurement {
    /// Measures a block with the joint at its end, which was played back, with or without what pictures
    /// need.
    pub fn of(
        plan: &Plan<'_>,
        block: &BlockPoints,
        playback: BlockPlayback,
        start: Option<&ServoStart>,
        sketch: bool,
    ) -> Result<Self> {
        let touch = &plan.preparation.touch;
        let figures = Meter::measure_played(touch, playback, &block.points, &block.offsets, sketch);
        let figures = figures.map_err(PipelineError::Measure)?;
        let servo = start.map(|start| ServoMeter::measure(touch, start, &block.points));
        let own_axes = plan
            .own_angles()
            .map(|angles| match is_between(&block.points, angles) {
                true => figures.axes,
                false => AxesMotion::between(&block.points, angles),
            });
        let has_limits = plan.preparation.task.machine.has_limits();
        let certain = has_limits
            .then(|| CertainBlock::of(Section::Cutting, &block.points, &Rounding::default()));
        Ok(Self {
            figures,
            certain,
            servo: servo.transpose().map_err(PipelineError::Measure)?,
            own_axes: own_axes.unwrap_or_default(),
            points: block.owner.len(),
            placed: block.placed,
        })
    }
}

/// More than the rounding of C at the end of a played segment, rad.
const ROUNDING: f64 = 1e-6;

/// Whether a block lies between two angles of C, rad, and not at the second one. C grows along the cut.
fn is_between(points: &PathBlock, [from, to]: [f64; 2]) -> bool {
    let ends = points.c.first().zip(points.c.last());
    ends.is_some_and(|(first, last)| *first >= from && *last <= to - ROUNDING)
}
