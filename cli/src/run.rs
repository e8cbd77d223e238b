//! `turnpath run`: the whole pipeline, and its files.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_core::Slot;
use turnpath_core::toolpath::SegmentShape;
use turnpath_host::{Catalogue, Plugin};
use turnpath_pipeline::{
    LeadLimits, LeadSettings, Outcome, PathOptions, RunError, run as run_pipeline,
};
use turnpath_post::{PMAC_TIME_STEPS, PmacError};
use turnpath_recipe::Recipe;

use crate::args::{Format, RunArgs};
use crate::coverage::Promise;
use crate::failure::Failure;
use crate::figures;
use crate::files::{Files, SinkError};
use crate::job::{Job, of_pipeline};
use crate::plots::Wishes;
use crate::programs::{asked, not_carried};
use crate::progress::Bar;
use crate::summary::{ProgramSummary, Summary};
use crate::unreached::Unreached;
use crate::{Done, Verdict};

/// Runs a recipe and writes its files.
pub fn run(args: &RunArgs) -> Done {
    let job = Job::ready(&args.recipe, &args.work)?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(job.recipe.folder_name()),
    };
    let programs = asked(&job.recipe, job.compensates_nose())?;
    refuse_straight_lines(&job)?;
    let wishes = wishes(args, &job, &folder)?;
    let making = making(&job);
    let wants_path = !job.recipe.output.data.is_empty();
    let mut files = Files::new(folder, wants_path, programs)?;
    let bar = Bar::new();
    let outcome = run_pipeline(&job.chain, &job.prepared, making, &mut files, &bar);
    let outcome = outcome.map_err(|error| {
        bar.clear();
        match error {
            RunError::Pipeline(error) => of_pipeline(&job.recipe, error),
            RunError::Sink(SinkError::Program(error)) => not_carried(&job.recipe, &error),
            RunError::Sink(SinkError::File(error)) => error.into(),
        }
    })?;
    let programs = files.read_back(&job, &args.recipe.set, &outcome, &bar);
    let plotted = match programs {
        Ok(_) => files.plot(&job, &wishes, &outcome, &bar),
        Err(_) => Ok(()),
    };
    bar.clear();
    let summary = summary(&job, files.rows, &outcome, programs?)?;
    plotted?;
    let written = files.complete(&summary.json())?;
    match args.work.format {
        Format::Json => print(&summary.json())?,
        Format::Human => print(&human(&job, &summary, &written))?,
    }
    Ok(if summary.all_hold() {
        Verdict::Holds
    } else {
        Verdict::Exceeded
    })
}

/// Maps and the like are measured on `toolpath.csv`.
fn wishes(args: &RunArgs, job: &Job, folder: &Path) -> Result<Wishes, Failure> {
    let wishes = Wishes::of(&args.plots, &job.recipe.part, folder)?;
    if !wishes.is_empty() && job.recipe.output.data.is_empty() {
        return Err(Failure::call(
            "--map, --profile, --circle and --spectrum are measured on toolpath.csv, which this \
             recipe does not write: add \"csv\" to `data` in [output]",
        ));
    }
    Ok(wishes)
}

/// How the path of a job is made.
pub fn making(job: &Job) -> PathOptions {
    PathOptions {
        refine: job.recipe.refine,
        time_steps: (!job.recipe.output.posts.is_empty()).then_some(PMAC_TIME_STEPS),
        lead: lead(job),
        servo: job.recipe.servo,
        covers_centre: Promise::of(job.recipe.overrun).covers_centre,
    }
}

/// What the path of a job gave.
///
/// # Errors
/// When the surface fails while it is looked at.
pub fn summary(
    job: &Job,
    rows: u64,
    outcome: &Outcome,
    programs: Vec<ProgramSummary>,
) -> Result<Summary, Failure> {
    let plugins = used_plugins(&job.recipe, &job.catalogue);
    let unreached = Unreached::of_job(job)?;
    Ok(Summary::new(
        &job.recipe,
        &job.chain,
        &plugins,
        rows,
        outcome,
        unreached,
        programs,
    ))
}

/// How the path comes and goes, where the recipe wants leads.
fn lead(job: &Job) -> Option<LeadSettings> {
    job.recipe.lead.then(|| LeadSettings {
        clearance: job.recipe.clearance,
        limits: LeadLimits::within(job.recipe.machine),
    })
}

/// A program in PVT mode plays cubics; a path of straight lines is another one.
pub fn refuse_straight_lines(job: &Job) -> Result<(), Failure> {
    let straight = job.chain.velocity.strategy.segments() == SegmentShape::Linear;
    if straight && !job.recipe.output.posts.is_empty() {
        return Err(not_carried(&job.recipe, &PmacError::Straight));
    }
    Ok(())
}

/// The plugins of the five strategies, each once.
pub fn used_plugins<'a>(recipe: &Recipe, catalogue: &'a Catalogue) -> Vec<&'a Plugin> {
    let mut used: Vec<&Plugin> = Vec::new();
    for slot in Slot::ALL {
        let name = recipe.choice(slot).name();
        if let Some(strategy) = catalogue.find(slot, name) {
            let plugin = strategy.plugin().as_ref();
            if !used.contains(&plugin) {
                used.push(plugin);
            }
        }
    }
    used
}

fn human(job: &Job, summary: &Summary, written: &[PathBuf]) -> String {
    let chain = &job.chain;
    let names = [
        &chain.surface.name,
        &chain.feed.name,
        &chain.sampler.name,
        &chain.compensator.name,
        &chain.velocity.name,
    ];
    let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
    let mut text = format!("{}\n", job.recipe.name);
    text += &figures::line("chain", names.join(" > "));
    let added = match (job.recipe.refine, summary.points_added_by_refine) {
        (false, _) => "not refined".to_owned(),
        (true, added) => format!("{} added by refine", figures::grouped(added)),
    };
    let points = figures::grouped(summary.control_points);
    text += &figures::line("points", format!("{points} ({added})"));
    text += &figures::line("revolutions", format!("{:.2}", summary.revolutions));
    text += &figures::line("cutting time", figures::duration(summary.cutting_time_s));
    text += &figures::measured(&summary.measured, &job.recipe);
    if let Some(lead) = &summary.measured.lead {
        text += &lead.lines(summary.measured.within.lead);
    }
    if let Some(servo) = &summary.measured.servo {
        text += &servo.lines();
    }
    if let Some(unreached) = &summary.unreached {
        text += &unreached.lines();
    }
    for program in &summary.programs {
        let (error, holds) = (program.interpolation_error_nm, program.within_interpolation);
        let tolerance = job.recipe.tolerance.interpolation;
        text += &figures::line(program.post, figures::against(error, tolerance, holds));
    }
    for file in written {
        text += &figures::line("file", file.display());
    }
    text
}

/// Writes to standard output. A reader that has gone, such as `head`, is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::output(&error)),
        Ok(()) => Ok(()),
    }
}
