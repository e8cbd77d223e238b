//! Measures blocks, delivers them to the sink, and adds up what was measured.

use rayon::prelude::*;
use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_verify::machined::{FormFigures, MachinedFigures};
use turnpath_verify::{
    AxesMotion, BlockFigures, FirstTouch, Meter, PathFigures, ServoBlockFigures, ServoFigures,
    ServoMeter, ServoStart,
};

use crate::error::{RunError, RunResult};
use crate::lead::Leads;
use crate::make::BlockPoints;
use crate::observer::{Observer, stop_if_cancelled};
use crate::order::in_order;
use crate::plan::Plan;
use crate::sink::Sink;
use crate::tail::{BlockContext, PathTail};
use crate::{PipelineError, Result};

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
    /// The surface that the path would leave; `None` where it cuts nothing of the part.
    pub machined: Option<MachinedFigures>,
    /// The form of that surface, where [`PathOptions::form`](crate::PathOptions::form) asks for it.
    pub form: Option<FormFigures>,
    /// The leads, where the path has some.
    pub lead: Option<Leads>,
    /// The predicted following error, where [`PathOptions::servo`](crate::PathOptions::servo) is
    /// given.
    pub servo: Option<ServoFigures>,
}

/// A block, measured and in the form that the sink keeps.
struct BlockRecord<B> {
    measured: BlockFigures,
    own_axes: AxesMotion,
    servo: Option<ServoBlockFigures>,
    points: usize,
    sampled: usize,
    encoded: B,
}

/// Delivers the path to its sink, and measures the cutting section on the way.
pub struct Recorder<'a, S: ?Sized> {
    sink: &'a mut S,
    observer: &'a dyn Observer,
    tail: PathTail,
    meter: Meter,
    servo: Option<ServoMeter>,
    points: u64,
    sampled: u64,
    own_axes: AxesMotion,
    /// How the axes move in the last block.
    last_motion: AxesMotion,
}

impl<'a, S: Sink + ?Sized> Recorder<'a, S> {
    /// A recorder of a path that has no point yet.
    pub fn new(
        sink: &'a mut S,
        observer: &'a dyn Observer,
        meter: Meter,
        servo: Option<ServoMeter>,
    ) -> Self {
        Self {
            sink,
            observer,
            tail: PathTail::default(),
            meter,
            servo,
            points: 0,
            sampled: 0,
            own_axes: AxesMotion::default(),
            last_motion: AxesMotion::default(),
        }
    }

    /// Lets the servo follow the points of the lead-in, which no figure counts.
    pub fn follow(&mut self, points: &PathBlock) {
        if let Some(servo) = &mut self.servo {
            servo.advance(points);
        }
    }

    /// Delivers a whole section without measuring it.
    pub fn deliver(&mut self, section: Section, points: &PathBlock) -> RunResult<(), S::Error> {
        let context = self.tail.extend(section, points, points.len());
        let block = context.block(section, points);
        let encoded = self.sink.encode(&block).map_err(RunError::Sink)?;
        self.take(points.len(), encoded)
    }

    /// Measures and encodes blocks of the cutting section in parallel, and delivers them in order.
    pub fn record(&mut self, plan: &Plan<'_>, blocks: Vec<BlockPoints>) -> RunResult<(), S::Error> {
        let (touch, own) = (&plan.preparation.touch, plan.own_angles());
        let contexts: Vec<BlockContext> = blocks
            .iter()
            .map(|block| {
                let (section, own) = (Section::Cutting, block.owner.len());
                self.tail.extend(section, &block.points, own)
            })
            .collect();
        let mut pass = |block: &BlockPoints| Some(self.servo.as_mut()?.advance(&block.points));
        let starts: Vec<Option<ServoStart>> = blocks.iter().map(&mut pass).collect();
        let sink = &*self.sink;
        let each = blocks.into_par_iter().zip(contexts).zip(starts);
        let records = in_order(each.map(|((block, context), start)| {
            measure_and_encode(touch, block, own, &context, start, sink)
        }))?;
        records.into_iter().try_for_each(|record| self.add(record))
    }

    fn add(&mut self, record: BlockRecord<S::Block>) -> RunResult<(), S::Error> {
        let appended = self.meter.append(&record.measured);
        appended.map_err(PipelineError::Measure)?;
        if let (Some(meter), Some(block)) = (&mut self.servo, &record.servo) {
            meter.append(block);
        }
        self.points += record.points as u64;
        self.sampled += record.sampled as u64;
        self.own_axes.append(&record.own_axes);
        self.last_motion = record.measured.axes;
        self.take(record.points, record.encoded)
    }

    fn take(&mut self, points: usize, encoded: S::Block) -> RunResult<(), S::Error> {
        stop_if_cancelled(self.observer)?;
        self.sink.take(points, encoded).map_err(RunError::Sink)
    }

    /// The end of the path so far.
    pub fn tail(&self) -> &PathTail {
        &self.tail
    }

    /// How the axes move in the last block of the cutting section.
    pub fn last_motion(&self) -> AxesMotion {
        self.last_motion
    }

    /// The result of the run.
    pub fn outcome(self, plan: &Plan<'_>, lead: Option<Leads>) -> Result<Outcome> {
        let revolutions = plan.law.end();
        Ok(Outcome {
            control_points: self.points,
            added_by_refine: self.points - self.sampled,
            revolutions,
            cutting_time: plan.spindle.time_at(revolutions),
            own_axes: plan.own_angles().map(|_| self.own_axes),
            machined: self.meter.machined().map_err(PipelineError::Measure)?,
            form: self.meter.form().map_err(PipelineError::Measure)?,
            figures: self.meter.figures().map_err(PipelineError::Measure)?,
            lead,
            servo: self.servo.map(|servo| *servo.figures()),
        })
    }
}

/// Measures a block, and encodes it without the joint with the next block.
fn measure_and_encode<S: Sink + ?Sized>(
    touch: &FirstTouch,
    block: BlockPoints,
    own: Option<[f64; 2]>,
    context: &BlockContext,
    start: Option<ServoStart>,
    sink: &S,
) -> RunResult<BlockRecord<S::Block>, S::Error> {
    let measured = Meter::measure_off(touch, &block.points, &block.offsets);
    let measured = measured.map_err(PipelineError::Measure)?;
    let servo = start.map(|start| ServoMeter::measure(touch, &start, &block.points));
    let servo = servo.transpose().map_err(PipelineError::Measure)?;
    let own_axes = own.map_or_else(AxesMotion::default, |angles| {
        AxesMotion::between(&block.points, angles)
    });
    let mut points = block.points;
    points.truncate(block.owner.len());
    let encoded = sink.encode(&context.block(Section::Cutting, &points));
    Ok(BlockRecord {
        measured,
        own_axes,
        servo,
        points: points.len(),
        sampled: block.sampled,
        encoded: encoded.map_err(RunError::Sink)?,
    })
}
