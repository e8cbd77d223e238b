//! `turnpath run`: the whole pipeline, and its files.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_core::Slot;
use turnpath_core::toolpath::PathStretch;
use turnpath_host::Plugin;
use turnpath_pipeline::{Outcome, Sink, run as run_pipeline};
use turnpath_post::{Draft, FileError, PathWriter, PmacWriter};

use crate::args::{Format, RunArgs};
use crate::failure::Failure;
use crate::figures;
use crate::job::{Job, of_pipeline};
use crate::programs::{Program, asked};
use crate::progress::Bar;
use crate::summary::{ProgramSummary, Summary};
use crate::{Done, Verdict};

/// Runs a recipe and writes its files.
pub fn run(args: &RunArgs) -> Done {
    let job = Job::ready(&args.recipe, &args.work)?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(job.recipe.folder_name()),
    };
    let programs = asked(&job.recipe, job.compensates_nose())?;
    let mut files = Files::new(folder, !job.recipe.output.data.is_empty(), programs);
    let bar = Bar::new();
    let outcome = run_pipeline(
        &job.chain,
        &job.prepared,
        job.recipe.refine,
        &mut files,
        &bar,
    );
    let outcome = outcome.map_err(|error| {
        bar.clear();
        of_pipeline(&job.recipe, error)
    })?;
    let programs = files.read_back(&job, &args.recipe.set, &outcome, &bar);
    bar.clear();
    let plugins = used_plugins(&job);
    let (recipe, chain) = (&job.recipe, &job.chain);
    let summary = Summary::new(recipe, chain, &plugins, files.rows, &outcome, programs?);
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

/// The plugins of the five strategies, each once.
fn used_plugins(job: &Job) -> Vec<&Plugin> {
    let mut used: Vec<&Plugin> = Vec::new();
    for slot in Slot::ALL {
        let name = job.recipe.choice(slot).name();
        if let Some(strategy) = job.catalogue.find(slot, name) {
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
    text += &figures::measured(&summary.measured, &job.recipe.tolerance);
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

/// The files of a run, begun with its first control points, so that a run which fails before
/// leaves nothing behind.
struct Files {
    folder: PathBuf,
    wants_path: bool,
    programs: Vec<Program>,
    begun: Option<Begun>,
    rows: u64,
}

#[derive(Default)]
struct Begun {
    made_folder: bool,
    path: Option<PathWriter>,
    programs: Vec<PmacWriter>,
    /// Programs that are whole, and still without their names.
    whole: Vec<Draft>,
}

impl Files {
    fn new(folder: PathBuf, wants_path: bool, programs: Vec<Program>) -> Self {
        Self {
            folder,
            wants_path,
            programs,
            begun: None,
            rows: 0,
        }
    }

    fn begin(&mut self) -> Result<(), FileError> {
        let made_folder = !self.folder.exists();
        let folder = |error| FileError {
            path: self.folder.clone(),
            error,
        };
        fs::create_dir_all(&self.folder).map_err(folder)?;
        // From here on the folder is removed again if anything fails.
        let begun = self.begun.insert(Begun {
            made_folder,
            ..Begun::default()
        });
        if self.wants_path {
            begun.path = Some(PathWriter::begin(self.folder.join("toolpath.csv"))?);
        }
        for program in &self.programs {
            begun.programs.push(program.begin(&self.folder)?);
        }
        Ok(())
    }

    /// Puts the programs together, reads each back and measures it on its own text.
    fn read_back(
        &mut self,
        job: &Job,
        sets: &[String],
        outcome: &Outcome,
        bar: &Bar,
    ) -> Result<Vec<ProgramSummary>, Failure> {
        let Some(begun) = &mut self.begun else {
            return Ok(Vec::new());
        };
        let mut measured = Vec::new();
        for (program, writer) in self.programs.iter().zip(begun.programs.drain(..)) {
            let mut draft = program.assemble(writer, &job.recipe, sets, outcome)?;
            let touch = job.prepared.touch.clone();
            measured.push(program.measure(&mut draft, &job.recipe, touch, self.rows, bar)?);
            begun.whole.push(draft);
        }
        Ok(measured)
    }

    /// Gives the files their names; the summary comes last, so that where it is, all is.
    fn complete(mut self, summary: &str) -> Result<Vec<PathBuf>, FileError> {
        let path = self.folder.join("summary.json");
        let mut draft = Draft::begin(&path)?;
        draft
            .write_all(summary.as_bytes())
            .map_err(|error| FileError { path, error })?;
        let mut written = Vec::new();
        if let Some(begun) = self.begun.take() {
            for program in begun.whole {
                written.push(program.complete()?);
            }
            if let Some(path) = begun.path {
                written.push(path.complete()?);
            }
        }
        written.push(draft.complete()?);
        Ok(written)
    }
}

impl Sink for Files {
    fn encode(&self, stretch: &PathStretch<'_>) -> io::Result<Vec<Vec<u8>>> {
        let mut encoded = Vec::new();
        if self.wants_path {
            encoded.push(PathWriter::rows(stretch.section, stretch.points)?);
        }
        for program in &self.programs {
            encoded.push(program.lines(stretch)?);
        }
        Ok(encoded)
    }

    fn take(&mut self, points: usize, encoded: &[Vec<u8>]) -> io::Result<()> {
        if self.begun.is_none() {
            self.begin()
                .map_err(|error| io::Error::other(error.to_string()))?;
        }
        self.rows += points as u64;
        let Some(begun) = &mut self.begun else {
            return Ok(());
        };
        let mut encoded = encoded.iter();
        if let Some((path, rows)) = begun.path.as_mut().zip(encoded.as_slice().first()) {
            path.append(rows)?;
            encoded.next();
        }
        for (program, lines) in begun.programs.iter_mut().zip(encoded) {
            program.append(points, lines)?;
        }
        Ok(())
    }
}

impl Drop for Files {
    /// Of a run that failed nothing stays, its folder neither if it made it.
    fn drop(&mut self) {
        if let Some(begun) = self.begun.take() {
            let made_folder = begun.made_folder;
            drop(begun);
            if made_folder {
                // It is left where something else has come into it meanwhile.
                let _ = fs::remove_dir(&self.folder);
            }
        }
    }
}
