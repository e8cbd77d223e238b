//! Delivers blocks to the sink in order, and has them measured on the way where that is asked. While
//! segments may still be halved, it looks at each block first, as it is played for its figures.

use rayon::prelude::*;
use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_verify::{AxesMotion, BlockPlayback, ServoStart};

use crate::error::{PipelineError, Result, RunError, RunResult};
use crate::make::BlockPoints;
use crate::measurement::{BlockMeasurement, Measurement};
use crate::observer::{Observer, stop_if_cancelled};
use crate::order::one_at_a_time;
use crate::plan::Plan;
use crate::refine::Refinement;
use crate::segment_state::{SegmentState, states};
use crate::sink::Sink;
use crate::tail::{BlockContext, PathTail};

/// A block in the form that the sink keeps, and what was measured on it.
struct BlockRecord<B> {
    measured: Option<BlockMeasurement>,
    /// How the axes move, where that is known already or may be asked.
    motion: Option<AxesMotion>,
    points: usize,
    encoded: B,
}

/// What a block is encoded and measured with.
struct BlockTask {
    block: BlockPoints,
    context: BlockContext,
    /// Where the servos are when the block begins; `None` without a model of them.
    start: Option<ServoStart>,
}

/// Delivers the path to its sink. With a measurement it measures the cutting section on the way.
pub struct Recorder<'a, S: ?Sized> {
    sink: &'a mut S,
    observer: &'a dyn Observer,
    measurement: Option<&'a mut Measurement>,
    tail: PathTail,
    /// How the axes move in the last block.
    last_motion: AxesMotion,
}

impl<'a, S: Sink + ?Sized> Recorder<'a, S> {
    /// A recorder of a path that has no point yet.
    pub fn new(
        sink: &'a mut S,
        observer: &'a dyn Observer,
        measurement: Option<&'a mut Measurement>,
    ) -> Self {
        Self {
            sink,
            observer,
            measurement,
            tail: PathTail::default(),
            last_motion: AxesMotion::default(),
        }
    }

    /// Lets the servo follow the points of the lead-in, which no figure counts.
    pub fn follow(&mut self, points: &PathBlock) {
        if let Some(measurement) = &mut self.measurement {
            measurement.advance(points);
        }
    }

    /// Delivers a whole section without measuring it.
    pub fn deliver(&mut self, section: Section, points: &PathBlock) -> RunResult<(), S::Error> {
        let context = self.tail.extend(section, points, points.len());
        let block = context.block(section, points);
        let encoded = self.sink.encode(&block).map_err(RunError::Sink)?;
        self.take(points.len(), encoded)
    }

    /// The same for a section of a path that is not refined yet. The answer is no if the sink cannot encode it:
    /// refinement may change it.
    pub fn deliver_unrefined(
        &mut self,
        section: Section,
        points: &PathBlock,
    ) -> RunResult<bool, S::Error> {
        let context = self.tail.extend(section, points, points.len());
        match self.sink.encode(&context.block(section, points)) {
            Ok(encoded) => self.take(points.len(), encoded).map(|()| true),
            Err(_) => Ok(false),
        }
    }

    /// Measures and encodes blocks of the cutting section in parallel, and delivers them in order.
    pub fn record(&mut self, plan: &Plan<'_>, blocks: Vec<BlockPoints>) -> RunResult<(), S::Error> {
        let tasks: Vec<BlockTask> = blocks.into_iter().map(|block| self.task(block)).collect();
        let sketch = self.keeps_sketch();
        let sink = &*self.sink;
        let each = tasks.into_par_iter();
        let records = one_at_a_time(each.map(|task| task.record(plan, sink, sketch)))?;
        self.add(records)
    }

    /// Plays back blocks of the cutting section that are not refined yet, and tells the refinement what
    /// shows. Where no segment of them is to be halved, they are recorded as by
    /// [`record`](Self::record), and the answer is yes. Else none is, and this recorder takes no more.
    /// If the sink cannot encode a block, none is recorded either: refinement may change it.
    pub fn record_unrefined(
        &mut self,
        plan: &Plan<'_>,
        blocks: Vec<BlockPoints>,
        refinement: &mut Refinement,
    ) -> RunResult<bool, S::Error> {
        let review = |block: &BlockPoints| {
            let playback = play_back(plan, block)?;
            let states = states(plan, block, &playback.per_segment)?;
            Ok::<_, PipelineError>((playback, states))
        };
        let reviews = one_at_a_time(blocks.par_iter().map(review))?;
        let mut holds = true;
        let mut played = Vec::new();
        for (block, (playback, states)) in blocks.into_iter().zip(reviews) {
            holds &= !states.contains(&SegmentState::Beyond);
            refinement.take(block.index, states);
            played.push((self.task(block), playback));
        }
        if !holds {
            return Ok(false);
        }
        let sketch = self.keeps_sketch().unwrap_or_default();
        let sink = &*self.sink;
        let each = played.into_par_iter();
        let record = |(task, playback): (BlockTask, _)| {
            task.record_played(plan, sink, Some((playback, sketch)))
        };
        match one_at_a_time(each.map(record)) {
            Err(RunError::Sink(_)) => Ok(false),
            records => self.add(records?).map(|()| true),
        }
    }

    /// Whether the measurement keeps what pictures need; `None` if nothing is measured.
    fn keeps_sketch(&self) -> Option<bool> {
        self.measurement.as_deref().map(Measurement::keeps_sketch)
    }

    fn task(&mut self, block: BlockPoints) -> BlockTask {
        let (section, own) = (Section::Cutting, block.owner.len());
        let measurement = self.measurement.as_mut();
        BlockTask {
            context: self.tail.extend(section, &block.points, own),
            start: measurement.and_then(|measurement| measurement.advance(&block.points)),
            block,
        }
    }

    /// Adds blocks in their order: one thread adds what was measured, and another one delivers.
    fn add(&mut self, records: Vec<BlockRecord<S::Block>>) -> RunResult<(), S::Error> {
        if let Some(last) = records.last() {
            self.last_motion = last.motion.unwrap_or_default();
        }
        let (mut measured, mut encoded) = (Vec::new(), Vec::new());
        for record in records {
            measured.extend(record.measured);
            encoded.push((record.points, record.encoded));
        }
        let (sink, observer) = (&mut *self.sink, self.observer);
        let (added, delivered) = rayon::join(
            || match &mut self.measurement {
                Some(measurement) => measured
                    .into_iter()
                    .try_for_each(|block| measurement.append(block)),
                None => Ok(()),
            },
            || {
                let mut encoded = encoded.into_iter();
                encoded.try_for_each(|(points, block)| take(sink, observer, points, block))
            },
        );
        added?;
        delivered
    }

    fn take(&mut self, points: usize, encoded: S::Block) -> RunResult<(), S::Error> {
        take(self.sink, self.observer, points, encoded)
    }

    /// The end of the path so far.
    pub fn tail(&self) -> &PathTail {
        &self.tail
    }

    /// How the axes move in the last block of the cutting section.
    pub fn last_motion(&self) -> AxesMotion {
        self.last_motion
    }
}

/// Gives the sink a block.
fn take<S: Sink + ?Sized>(
    sink: &mut S,
    observer: &dyn Observer,
    points: usize,
    encoded: S::Block,
) -> RunResult<(), S::Error> {
    stop_if_cancelled(observer)?;
    sink.take(points, encoded).map_err(RunError::Sink)
}

impl BlockTask {
    /// Measures the block with the joint with the next block, and encodes it without the joint. `sketch` says whether
    /// the measurement keeps what pictures need; it is `None` if nothing is measured.
    fn record<S: Sink + ?Sized>(
        self,
        plan: &Plan<'_>,
        sink: &S,
        sketch: Option<bool>,
    ) -> RunResult<BlockRecord<S::Block>, S::Error> {
        let playback = sketch.map(|_| play_back(plan, &self.block)).transpose()?;
        self.record_played(plan, sink, playback.zip(sketch))
    }

    /// Measures what the playback leaves open, where there is one, and encodes the block.
    fn record_played<S: Sink + ?Sized>(
        self,
        plan: &Plan<'_>,
        sink: &S,
        playback: Option<(BlockPlayback, bool)>,
    ) -> RunResult<BlockRecord<S::Block>, S::Error> {
        let Self {
            block,
            context,
            start,
        } = self;
        let measure = |(playback, sketch)| {
            BlockMeasurement::of(plan, &block, playback, start.as_ref(), sketch)
        };
        let measured = playback.map(measure).transpose()?;
        let motion = match &measured {
            Some(measured) => Some(measured.figures.axes),
            None => block.ends_path.then(|| AxesMotion::of(&block.points)),
        };
        let mut points = block.points;
        points.truncate(block.owner.len());
        let encoded = sink.encode(&context.block(Section::Cutting, &points));
        Ok(BlockRecord {
            measured,
            motion,
            points: points.len(),
            encoded: encoded.map_err(RunError::Sink)?,
        })
    }
}

fn play_back(plan: &Plan<'_>, block: &BlockPoints) -> Result<BlockPlayback> {
    let playback = BlockPlayback::of(&plan.preparation.touch, &block.points);
    playback.map_err(PipelineError::Measure)
}
