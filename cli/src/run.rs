//! `turnpath run`: the whole pipeline, and its files.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_core::Slot;
use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_host::Plugin;
use turnpath_pipeline::{Sink, run as run_pipeline};
use turnpath_post::{Draft, FileError, PathWriter};

use crate::args::{Format, RunArgs};
use crate::failure::Failure;
use crate::figures;
use crate::job::{Job, of_pipeline};
use crate::progress::Bar;
use crate::summary::Summary;
use crate::{Done, Verdict};

/// Runs a recipe and writes its files.
pub fn run(args: &RunArgs) -> Done {
    let job = Job::ready(&args.recipe, &args.work)?;
    let folder = match &args.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(job.recipe.folder_name()),
    };
    let mut files = Files::new(folder, !job.recipe.output.data.is_empty());
    let bar = Bar::new();
    let outcome = run_pipeline(
        &job.chain,
        &job.prepared,
        job.recipe.refine,
        &mut files,
        &bar,
    );
    bar.clear();
    let outcome = outcome.map_err(|error| of_pipeline(&job.recipe, error))?;
    let plugins = used_plugins(&job);
    let summary = Summary::new(&job.recipe, &job.chain, &plugins, files.rows, &outcome);
    let written = files.complete(&summary.json())?;
    match args.work.format {
        Format::Json => print(&summary.json())?,
        Format::Human => print(&human(&job, &summary, &written))?,
    }
    Ok(if summary.measured.all_hold() {
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
    begun: Option<Begun>,
    rows: u64,
}

struct Begun {
    path: Option<PathWriter>,
    made_folder: bool,
}

impl Files {
    fn new(folder: PathBuf, wants_path: bool) -> Self {
        Self {
            folder,
            wants_path,
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
        self.begun = Some(Begun {
            path: None,
            made_folder,
        });
        if self.wants_path {
            let path = PathWriter::begin(self.folder.join("toolpath.csv"))?;
            self.begun = Some(Begun {
                path: Some(path),
                made_folder,
            });
        }
        Ok(())
    }

    /// Gives the files their names; the summary comes last, so that where it is, all is.
    fn complete(mut self, summary: &str) -> Result<Vec<PathBuf>, FileError> {
        let path = self.folder.join("summary.json");
        let mut draft = Draft::begin(&path)?;
        draft
            .write_all(summary.as_bytes())
            .map_err(|error| FileError { path, error })?;
        let mut written = Vec::new();
        if let Some(path) = self.begun.take().and_then(|begun| begun.path) {
            written.push(path.complete()?);
        }
        written.push(draft.complete()?);
        Ok(written)
    }
}

impl Sink for Files {
    fn encode(&self, section: Section, points: &PathBlock) -> io::Result<Vec<u8>> {
        match self.wants_path {
            true => PathWriter::rows(section, points),
            false => Ok(Vec::new()),
        }
    }

    fn take(&mut self, points: usize, encoded: &[u8]) -> io::Result<()> {
        if self.begun.is_none() {
            self.begin()
                .map_err(|error| io::Error::other(error.to_string()))?;
        }
        self.rows += points as u64;
        match self.begun.as_mut().and_then(|begun| begun.path.as_mut()) {
            Some(path) => path.append(encoded),
            None => Ok(()),
        }
    }
}

impl Drop for Files {
    /// Of a run that failed nothing stays, its folder neither if it made it.
    fn drop(&mut self) {
        if let Some(Begun { path, made_folder }) = self.begun.take() {
            drop(path);
            if made_folder {
                // It is left where something else has come into it meanwhile.
                let _ = fs::remove_dir(&self.folder);
            }
        }
    }
}
