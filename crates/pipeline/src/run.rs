//! The whole run: the law, then every block made, played back, measured and delivered in order. At the
//! first segment that is to be halved, or at the first block that the sink cannot encode, what was
//! delivered is dropped. The path is then refined, and all its blocks are made, measured and delivered
//! anew.

use std::ops::RangeInclusive;

use rayon::prelude::*;
use turnpath_core::toolpath::Section;

use crate::ahead::placing_ahead;
use crate::blocks::Blocks;
use crate::error::RunResult;
use crate::estimate::{Estimate, nodes_per_revolution};
use crate::lead::{LeadRun, LeadTask, Leads};
use crate::make::{BlockPoints, Depths};
use crate::measurement::{Measurement, Outcome};
use crate::observer::{Observer, Stage, stop_if_cancelled};
use crate::options::PathOptions;
use crate::plan::{Plan, Start};
use crate::recorder::Recorder;
use crate::refine::{Refinement, refine};
use crate::sink::{DraftSink, Sink};
use crate::{Chain, PipelineError, Preparation, Result, RunError, schedule};

/// Blocks that are made at a time for each thread: enough that the last one to end does not keep the others
/// waiting for long, and few enough that what was measured on them is written down while it is in the
/// cache and its memory is used again.
const BLOCKS_A_THREAD: usize = 4;
/// The same where nodes are not held. Each batch also places the nodes of some blocks beside it. With larger batches,
/// fewer nodes are placed twice.
const PLACED_BLOCKS_A_THREAD: usize = 8;
/// Most blocks that are made at a time, so that a batch of large blocks (half a million nodes each) stays
/// within some hundred megabytes.
const LARGE_BATCH: usize = 64;
/// Control points that a batch should not exceed much.
const BATCH_POINTS: f64 = 5e5;
/// Control points of a batch for each thread. More of them take fresh memory, whose first use costs time.
const POINTS_A_THREAD: f64 = 1.5e5;
/// The blocks behind the first one that a lead-in and the first block wait for. A solver may see nodes of the
/// second block. The last step of that block ends where the third one begins.
const WANTED_FIRST: RangeInclusive<usize> = 1..=2;

/// Makes the path, measures it, and gives it to the sink.
///
/// # Errors
/// [`RunError::Pipeline`] when there is no path or when the observer cancels the run,
/// [`RunError::Sink`] when the sink fails.
pub fn run<S: DraftSink + ?Sized>(
    chain: &Chain,
    preparation: &Preparation,
    options: PathOptions,
    sink: &mut S,
    observer: &dyn Observer,
) -> std::result::Result<Outcome, RunError<S::Error>> {
    let mut path = PathRun::new(chain, preparation, options, observer)?;
    sink.expect(&path.estimate).map_err(RunError::Sink)?;
    let begin = || Measurement::new(preparation, &options);
    let mut measurement = begin();
    let leads = match path.deliver_first(sink, &mut measurement)? {
        FirstPass::Whole(leads) => leads.map(|leads| *leads),
        FirstPass::Refines(round) => {
            sink.drop_draft();
            measurement = begin();
            let depths = path.refine(*round)?;
            path.deliver(sink, &depths, Some(&mut measurement))?
        }
    };
    observer.measures(true);
    let outcome = measurement.outcome(&path.plan, leads);
    observer.measures(false);
    Ok(outcome?)
}

/// Makes the same path as [`run`] and gives it to the sink, without measuring what it would cut. The
/// sink gets no block before the path is refined.
///
/// # Errors
/// As [`run`].
pub fn make_unmeasured<S: Sink + ?Sized>(
    chain: &Chain,
    preparation: &Preparation,
    options: PathOptions,
    sink: &mut S,
    observer: &dyn Observer,
) -> std::result::Result<(), RunError<S::Error>> {
    let mut path = PathRun::new(chain, preparation, options, observer)?;
    sink.expect(&path.estimate).map_err(RunError::Sink)?;
    let mut depths = Vec::new();
    if options.refine {
        // The first round then plays the same numbers as that of a run.
        path.begins_unrefined()?;
        depths = path.refine(path.first_round())?;
    }
    path.deliver(sink, &depths, None)?;
    Ok(())
}

/// A path of which all is known but its refinement and its points.
struct PathRun<'a> {
    plan: Plan<'a>,
    options: PathOptions,
    estimate: Estimate,
    /// Blocks that are made at a time.
    batch: usize,
    /// What the leads are made for, once it is known.
    lead_task: Option<LeadTask>,
    /// The leads, from the lead-in on.
    leads: Option<LeadRun>,
    observer: &'a dyn Observer,
}

/// How the first pass over a path ended.
enum FirstPass {
    /// The sink has the whole path.
    Whole(Option<Box<Leads>>),
    /// The path is to be refined first.
    Refines(Box<FirstRound>),
}

/// The first round of refinement, as far as it is played.
struct FirstRound {
    seen: Refinement,
    /// The blocks that were made and not played.
    ahead: Option<Vec<BlockPoints>>,
    /// The blocks that were not made.
    rest: Blocks,
}

impl FirstRound {
    /// The next blocks to be played; `make` makes them where they are not made.
    fn next(
        &mut self,
        make: impl FnOnce(&mut Blocks) -> Result<Option<Vec<BlockPoints>>>,
    ) -> Result<Option<Vec<BlockPoints>>> {
        match self.ahead.take() {
            Some(made) => Ok(Some(made)),
            None => make(&mut self.rest),
        }
    }
}

impl<'a> PathRun<'a> {
    /// Plans the path.
    fn new(
        chain: &'a Chain,
        preparation: &'a Preparation,
        options: PathOptions,
        observer: &'a dyn Observer,
    ) -> Result<Self> {
        observer.begin(Stage::Law, 0);
        let mut plan = schedule::plan(chain, preparation, observer)?;
        plan.time_steps = options.time_steps;
        plan.hold_nodes();
        let wanted = WANTED_FIRST.into_par_iter();
        let place_first = || wanted.for_each(|index| plan.place_ahead(index));
        let (nodes, ()) = rayon::join(|| nodes_per_revolution(&plan), place_first);
        let nodes = nodes?;
        Ok(Self {
            estimate: Estimate::of(&plan, nodes)?,
            batch: batch_size(&plan, nodes),
            plan,
            options,
            lead_task: None,
            leads: None,
            observer,
        })
    }

    /// Delivers and measures the path as long as no segment of it is to be halved. The playback that the
    /// meters need is the first round of refinement too.
    fn deliver_first<S: Sink + ?Sized>(
        &mut self,
        sink: &mut S,
        measurement: &mut Measurement,
    ) -> RunResult<FirstPass, S::Error> {
        if !self.options.refine {
            let leads = self.deliver(sink, &[], Some(measurement))?;
            return Ok(FirstPass::Whole(leads.map(Box::new)));
        }
        let mut round = self.first_round();
        if !self.begins_unrefined()? {
            return Ok(FirstPass::Refines(Box::new(round)));
        }
        let mut recorder = Recorder::new(sink, self.observer, Some(measurement));
        if let Some(leads) = &self.leads {
            recorder.follow(&leads.lead_in_and_join());
            if !recorder.deliver_unrefined(Section::LeadIn, &leads.lead_in())? {
                return Ok(FirstPass::Refines(Box::new(round)));
            }
        }
        self.begin_cut();
        let record = || self.record_unrefined(&mut recorder, &mut round);
        if !placing_ahead(&self.plan, record)? {
            return Ok(FirstPass::Refines(Box::new(round)));
        }
        let leads = self.end_path(recorder)?;
        Ok(FirstPass::Whole(leads.map(Box::new)))
    }

    /// Records the cut as long as no segment of it is to be halved. Gives whether none is.
    fn record_unrefined<S: Sink + ?Sized>(
        &self,
        recorder: &mut Recorder<'_, S>,
        round: &mut FirstRound,
    ) -> RunResult<bool, S::Error> {
        let FirstRound { seen, ahead, rest } = round;
        *ahead = self.make(rest, &[])?;
        while let Some(made) = ahead.take() {
            let record = |made| recorder.record_unrefined(&self.plan, made, seen);
            let (holds, next) = self.record_and_make(made, record, rest, &[])?;
            *ahead = next;
            if !holds {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Delivers the path with its segments halved so often, and measures it where that is asked.
    fn deliver<S: Sink + ?Sized>(
        &mut self,
        sink: &mut S,
        depths: &[Depths],
        measurement: Option<&mut Measurement>,
    ) -> RunResult<Option<Leads>, S::Error> {
        stop_if_cancelled(self.observer)?;
        self.begin_leads(depths)?;
        let mut recorder = Recorder::new(sink, self.observer, measurement);
        if let Some(leads) = &self.leads {
            recorder.follow(&leads.lead_in_and_join());
            recorder.deliver(Section::LeadIn, &leads.lead_in())?;
        }
        self.begin_cut();
        let mut blocks = self.blocks();
        let mut ahead = self.make(&mut blocks, depths)?;
        while let Some(made) = ahead {
            let record = |made| recorder.record(&self.plan, made);
            ((), ahead) = self.record_and_make(made, record, &mut blocks, depths)?;
        }
        self.end_path(recorder)
    }

    /// Records blocks, and makes those behind them on threads that have nothing else to do. A thread alone
    /// makes them afterwards.
    fn record_and_make<T: Send, E: Send>(
        &self,
        made: Vec<BlockPoints>,
        record: impl FnOnce(Vec<BlockPoints>) -> RunResult<T, E> + Send,
        rest: &mut Blocks,
        depths: &[Depths],
    ) -> RunResult<(T, Option<Vec<BlockPoints>>), E> {
        let count = made.len() as u64;
        let record = || {
            self.observer.measures(true);
            let recorded = record(made);
            self.observer.measures(false);
            self.observer.advance(count);
            recorded
        };
        let (recorded, next) = rayon::join(record, || self.make(rest, depths));
        Ok((recorded?, next?))
    }

    /// Plays the rest of the blocks, and halves segments until the path holds. Gives how often each is
    /// halved. The path is without leads then.
    fn refine(&mut self, mut round: FirstRound) -> Result<Vec<Depths>> {
        let observer = self.observer;
        let ahead = round.ahead.as_ref().map_or(0, Vec::len);
        let left = ahead + round.rest.left(&self.plan);
        observer.begin(Stage::Refine(1), left as u64);
        placing_ahead(&self.plan, || self.play_rest(&mut round))?;
        self.leads = None;
        self.plan.start = Start::default();
        let all: Vec<usize> = (0..self.plan.blocks()).collect();
        let depths = round.seen.finish(&self.plan, self.batch, &all, observer)?;
        let is_slower = schedule::slow_down_refined(&mut self.plan, &depths, observer)?;
        if is_slower && self.plan.time_steps.is_some() {
            // At another speed the points lie on other steps of the controller's time.
            return refine(&self.plan, self.batch, &all, observer);
        }
        Ok(depths)
    }

    /// Plays the rest of the blocks.
    fn play_rest(&self, round: &mut FirstRound) -> Result<()> {
        while let Some(made) = round.next(|rest| self.make(rest, &[]))? {
            round.seen.play(&self.plan, &made)?;
            self.observer.advance(made.len() as u64);
        }
        Ok(())
    }

    /// Nothing is played yet.
    fn first_round(&self) -> FirstRound {
        FirstRound {
            seen: Refinement::new(&self.plan),
            ahead: None,
            rest: self.blocks(),
        }
    }

    /// All blocks of the path.
    fn blocks(&self) -> Blocks {
        Blocks::of(&self.plan, self.batch)
    }

    /// The next blocks, unless the run is cancelled.
    fn make(&self, blocks: &mut Blocks, depths: &[Depths]) -> Result<Option<Vec<BlockPoints>>> {
        stop_if_cancelled(self.observer)?;
        blocks.next(&self.plan, depths)
    }

    /// Makes the lead-in, where the path has one, and moves the cut after it.
    fn begin_leads(&mut self, depths: &[Depths]) -> Result<()> {
        let Some(settings) = self.options.lead else {
            return Ok(());
        };
        let task = match self.lead_task {
            Some(task) => task,
            None => LeadTask::new(&self.plan, settings)?,
        };
        self.lead_task = Some(task);
        self.leads = Some(LeadRun::begin(&mut self.plan, depths, task)?);
        Ok(())
    }

    /// Makes the lead-in of the path as the sampler has it. Where there is none, it says so: refinement
    /// may make one possible.
    fn begins_unrefined(&mut self) -> Result<bool> {
        match self.begin_leads(&[]) {
            Err(PipelineError::Lead { .. }) => {
                self.plan.start = Start::default();
                Ok(false)
            }
            begun => begun.map(|()| true),
        }
    }

    /// Tells the observer that the cut is written next.
    fn begin_cut(&self) {
        let blocks = self.plan.blocks() as u64;
        self.observer.begin(Stage::Write, blocks);
    }

    /// Delivers the lead-out.
    fn end_path<S: Sink + ?Sized>(
        &mut self,
        mut recorder: Recorder<'_, S>,
    ) -> RunResult<Option<Leads>, S::Error> {
        let Some((leads, pair)) = self.leads.take().zip(recorder.tail().last_two()) else {
            return Ok(None);
        };
        stop_if_cancelled(self.observer)?;
        let (points, leads) = leads.end(&self.plan, &pair, recorder.last_motion())?;
        recorder.deliver(Section::LeadOut, &points)?;
        Ok(Some(leads))
    }
}

/// How many blocks are made at a time. It changes memory and speed, never the path.
fn batch_size(plan: &Plan<'_>, nodes_per_revolution: f64) -> usize {
    let per_block = nodes_per_revolution * plan.block();
    let threads = rayon::current_num_threads();
    let points = BATCH_POINTS.min(POINTS_A_THREAD * threads as f64);
    let fitting = (points / per_block.max(1.0)) as usize;
    let of_thread = match plan.holds_nodes() {
        true => BLOCKS_A_THREAD,
        false => PLACED_BLOCKS_A_THREAD,
    };
    let wanted = of_thread * threads;
    fitting.clamp(1, wanted.min(LARGE_BATCH))
}
