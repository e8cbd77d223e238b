//! The whole run: the law, refinement, then every block made, measured where that is asked, and
//! delivered in order.

use turnpath_core::toolpath::Section;

use crate::error::RunResult;
use crate::estimate::{Estimate, nodes_per_revolution};
use crate::lead::{LeadRun, Leads};
use crate::make::{Depths, close_joints, first_state, make};
use crate::measurement::{Measurement, Outcome};
use crate::observer::{Observer, Stage, stop_if_cancelled};
use crate::options::PathOptions;
use crate::plan::Plan;
use crate::recorder::Recorder;
use crate::refine::{refine, runs};
use crate::sink::Sink;
use crate::{Chain, Preparation, RunError, schedule};

/// Most blocks that are made at a time: enough for every thread, and few enough that a batch of
/// large blocks (half a million nodes each) stays within some hundred megabytes.
const LARGE_BATCH: usize = 64;
/// Control points that a batch should not exceed much.
const BATCH_POINTS: f64 = 5e5;

/// Makes the path, measures it, and gives it to the sink.
///
/// # Errors
/// [`RunError::Pipeline`] when there is no path or when the observer cancels the run,
/// [`RunError::Sink`] when the sink fails.
pub fn run<S: Sink + ?Sized>(
    chain: &Chain,
    preparation: &Preparation,
    options: PathOptions,
    sink: &mut S,
    observer: &dyn Observer,
) -> std::result::Result<Outcome, RunError<S::Error>> {
    let ready = ReadyPath::new(chain, preparation, options, sink, observer)?;
    let mut measurement = Measurement::new(preparation, &options);
    let recorder = Recorder::new(sink, observer, Some(&mut measurement));
    let (plan, lead) = ready.write(recorder, observer)?;
    observer.measures(true);
    let outcome = measurement.outcome(&plan, lead);
    observer.measures(false);
    Ok(outcome?)
}

/// Makes the same path as [`run`] and gives it to the sink, without measuring what it would cut.
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
    let ready = ReadyPath::new(chain, preparation, options, sink, observer)?;
    ready.write(Recorder::new(sink, observer, None), observer)?;
    Ok(())
}

/// A path of which all is known but its points.
struct ReadyPath<'a> {
    plan: Plan<'a>,
    /// Blocks that are made at a time.
    batch: usize,
    depths: Vec<Depths>,
    leads: Option<LeadRun>,
}

impl<'a> ReadyPath<'a> {
    /// Plans the path, tells the sink how long it will be, refines it, and makes its lead-in.
    fn new<S: Sink + ?Sized>(
        chain: &'a Chain,
        preparation: &'a Preparation,
        options: PathOptions,
        sink: &mut S,
        observer: &dyn Observer,
    ) -> RunResult<Self, S::Error> {
        observer.begin(Stage::Law, 0);
        let mut plan = schedule::plan(chain, preparation, observer)?;
        plan.time_steps = options.time_steps;
        if options.refine {
            plan.hold_nodes();
        }
        let nodes = nodes_per_revolution(&plan)?;
        let estimate = Estimate::of(&plan, nodes)?;
        sink.expect(&estimate).map_err(RunError::Sink)?;
        let batch = batch_size(&plan, nodes);
        let refined = |plan: &Plan<'_>| match options.refine {
            true => {
                let all: Vec<usize> = (0..plan.blocks()).collect();
                refine(plan, batch, &all, observer)
            }
            false => Ok(Vec::new()),
        };
        let mut depths = refined(&plan)?;
        let is_slower = schedule::slow_down_refined(&mut plan, &depths, observer)?;
        if is_slower && plan.time_steps.is_some() {
            // At another speed the points lie on other steps of the controller's time.
            depths = refined(&plan)?;
        }
        stop_if_cancelled(observer)?;
        let leads = options
            .lead
            .map(|settings| LeadRun::begin(&mut plan, &depths, settings))
            .transpose()?;
        Ok(Self {
            plan,
            batch,
            depths,
            leads,
        })
    }

    /// Makes the blocks and the lead-out, and gives all to the recorder.
    fn write<S: Sink + ?Sized>(
        self,
        mut recorder: Recorder<'_, S>,
        observer: &dyn Observer,
    ) -> RunResult<(Plan<'a>, Option<Leads>), S::Error> {
        let Self {
            plan,
            batch,
            depths,
            leads,
        } = self;
        if let Some(leads) = &leads {
            recorder.follow(&leads.lead_in_and_join());
            recorder.deliver(Section::LeadIn, &leads.lead_in())?;
        }
        let indices: Vec<usize> = (0..plan.blocks()).collect();
        observer.begin(Stage::Write, indices.len() as u64);
        let (mut waiting, mut state) = (Vec::new(), first_state(&plan));
        for range in runs(&indices, batch) {
            stop_if_cancelled(observer)?;
            let mut blocks = waiting;
            blocks.extend(make(&plan, range.clone(), &depths, state.as_mut())?);
            close_joints(&mut blocks);
            // The last block waits for the first point of the next one.
            waiting = blocks.split_off(blocks.len() - usize::from(range.end < plan.blocks()));
            observer.measures(true);
            recorder.record(&plan, blocks)?;
            observer.measures(false);
            observer.advance(range.len() as u64);
        }
        let lead = match leads.zip(recorder.tail().last_two()) {
            None => None,
            Some((leads, pair)) => {
                stop_if_cancelled(observer)?;
                let (points, leads) = leads.end(&plan, &pair, recorder.last_motion())?;
                recorder.deliver(Section::LeadOut, &points)?;
                Some(leads)
            }
        };
        Ok((plan, lead))
    }
}

/// How many blocks are made at a time. It changes memory and speed, never the path.
fn batch_size(plan: &Plan<'_>, nodes_per_revolution: f64) -> usize {
    let per_block = nodes_per_revolution * plan.block();
    let fitting = (BATCH_POINTS / per_block.max(1.0)) as usize;
    fitting.clamp(1, LARGE_BATCH)
}
