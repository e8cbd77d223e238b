//! The whole run: the law, refinement, then every block made, measured and delivered in order.

use turnpath_core::toolpath::Section;
use turnpath_verify::{Meter, ServoMeter};

use crate::error::RunResult;
use crate::estimate::nodes_per_revolution;
use crate::lead::LeadRun;
use crate::make::{Depths, close_joints, first_state, make};
use crate::observer::{Observer, Stage, stop_if_cancelled};
use crate::options::PathOptions;
use crate::plan::Plan;
use crate::recorder::{Outcome, Recorder};
use crate::refine::{refine, runs};
use crate::sink::Sink;
use crate::{Chain, Preparation, Result, RunError, schedule};

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
    observer.begin(Stage::Law, 1);
    let mut plan = schedule::plan(chain, preparation, observer)?;
    plan.time_steps = options.time_steps;
    let batch = batch_size(&plan)?;
    let depths = match options.refine {
        true => refine(&plan, batch, observer)?,
        false => Vec::new(),
    };
    stop_if_cancelled(observer)?;
    let leads = options
        .lead
        .map(|settings| LeadRun::begin(&mut plan, &depths, settings))
        .transpose()?;
    let meter = Meter::new(preparation.touch.clone())
        .counting_centre(options.covers_centre)
        .with_form(options.form);
    let servo = options.servo.as_ref().map(ServoMeter::new);
    let recorder = Recorder::new(sink, observer, meter, servo);
    write(&plan, batch, &depths, leads, recorder, observer)
}

fn write<S: Sink + ?Sized>(
    plan: &Plan<'_>,
    batch: usize,
    depths: &[Depths],
    leads: Option<LeadRun>,
    mut recorder: Recorder<'_, S>,
    observer: &dyn Observer,
) -> RunResult<Outcome, S::Error> {
    if let Some(leads) = &leads {
        recorder.follow(&leads.lead_in_and_join());
        recorder.deliver(Section::LeadIn, &leads.lead_in())?;
    }
    let indices: Vec<usize> = (0..plan.blocks()).collect();
    observer.begin(Stage::Write, indices.len() as u64);
    let (mut waiting, mut state) = (Vec::new(), first_state(plan));
    for range in runs(&indices, batch) {
        stop_if_cancelled(observer)?;
        let mut blocks = waiting;
        blocks.extend(make(plan, range.clone(), depths, state.as_mut())?);
        close_joints(&mut blocks);
        // The last block waits for the first point of the next one.
        waiting = blocks.split_off(blocks.len() - usize::from(range.end < plan.blocks()));
        recorder.record(plan, blocks)?;
        observer.advance(range.len() as u64);
    }
    let lead = match leads.zip(recorder.tail().last_two()) {
        None => None,
        Some((leads, pair)) => {
            stop_if_cancelled(observer)?;
            let (points, leads) = leads.end(plan, &pair, recorder.last_motion())?;
            recorder.deliver(Section::LeadOut, &points)?;
            Some(leads)
        }
    };
    Ok(recorder.outcome(plan, lead)?)
}

/// How many blocks are made at a time. It changes memory and speed, never the path.
fn batch_size(plan: &Plan<'_>) -> Result<usize> {
    let per_block = nodes_per_revolution(plan)? * plan.block();
    let fitting = (BATCH_POINTS / per_block.max(1.0)) as usize;
    Ok(fitting.clamp(1, LARGE_BATCH))
}
