//! The files of a run: begun with its first control points, and named when all is done.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::SectionBlock;
use turnpath_pipeline::{Estimate, Observer, Outcome, Sink};
use turnpath_post::{Draft, FileError, PathReader, PathWriter, PmacReader, PmacWriter};
use turnpath_report::ProgramReport;

use crate::error::Error;
use crate::job::Job;
use crate::plots::{PlayedPath, Plots, draw};
use crate::program::Program;
use crate::sinks::SinkError;
use crate::sizes::{check_room, toolpath_bytes};

/// Names of the files in the folder.
const TOOLPATH: &str = "toolpath.csv";
const SUMMARY: &str = "summary.json";

/// The files of a run. They are begun with the first control points, so that a run which fails
/// before that leaves nothing behind; one that fails later removes them again.
pub struct FolderSink<'a> {
    folder: PathBuf,
    writes_toolpath: bool,
    programs: &'a [Program],
    /// The outer end of the range of ρ, mm.
    radius: f64,
    files: Option<Files>,
    rows: u64,
}

/// The files in the making.
#[derive(Default)]
struct Files {
    /// Folders that were made for the files, the deepest first.
    new_folders: Vec<PathBuf>,
    toolpath: Option<PathWriter>,
    programs: Vec<PmacWriter>,
    /// Files that are whole, and still without their names.
    drafts: Vec<Draft>,
}

/// A block in the form of each file.
pub struct FileBlock {
    rows: Option<Vec<u8>>,
    lines: Vec<Vec<u8>>,
}

impl<'a> FolderSink<'a> {
    /// Nothing yet.
    ///
    /// # Errors
    /// When something is in the way that would stop the run only at its end.
    pub fn new(folder: &Path, job: &'a Job) -> Result<Self, FileError> {
        let programs = &job.programs;
        let names = programs.iter().map(|program| program.file.as_str());
        nothing_in_the_way(folder, names.chain([TOOLPATH, SUMMARY]))?;
        Ok(Self {
            folder: folder.to_owned(),
            writes_toolpath: !job.recipe.output.data.is_empty(),
            programs,
            radius: job.preparation.task.range.outer,
            files: None,
            rows: 0,
        })
    }

    /// Control points so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    fn begin(&self) -> Result<Files, FileError> {
        let missing = self.folder.ancestors();
        let missing = missing.take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let new_folders = missing.map(Path::to_owned).collect();
        fs::create_dir_all(&self.folder).map_err(|error| FileError {
            path: self.folder.clone(),
            error,
        })?;
        // From here on the folders are removed again if anything fails.
        let mut files = Files::default();
        files.new_folders = new_folders;
        if self.writes_toolpath {
            files.toolpath = Some(PathWriter::begin(self.folder.join(TOOLPATH))?);
        }
        for program in self.programs {
            let file = self.folder.join(&program.file);
            files.programs.push(PmacWriter::begin(file)?);
        }
        Ok(files)
    }

    /// Puts the programs together, reads each back and measures it on its own text.
    pub fn read_back(
        &mut self,
        job: &Job,
        outcome: &Outcome,
        observer: &dyn Observer,
    ) -> Result<Vec<ProgramReport>, Error> {
        let Some(files) = &mut self.files else {
            return Ok(Vec::new());
        };
        let mut reports = Vec::new();
        for (program, writer) in self.programs.iter().zip(files.programs.drain(..)) {
            let frame = program.frame(&job.recipe, outcome);
            let mut draft = writer.assemble(&frame.header, &frame.footer)?;
            let name = draft.path().to_owned();
            let reader = PmacReader::open(draft.readable()?, program.format);
            let mut reader = reader.map_err(|error| error.named(&name))?.named(&name);
            let touch = job.preparation.touch.clone();
            let (recipe, rows) = (&job.recipe, self.rows);
            reports.push(program.measure(&mut reader, &name, recipe, touch, rows, observer)?);
            files.drafts.push(draft);
        }
        Ok(reports)
    }

    /// Draws maps, profiles, circles and spectra of `toolpath.csv` as it stands.
    pub fn plot(
        &mut self,
        job: &Job,
        plots: &Plots,
        outcome: &Outcome,
        observer: &dyn Observer,
    ) -> Result<(), Error> {
        let Some(files) = self.files.as_mut().filter(|_| !plots.is_empty()) else {
            return Ok(());
        };
        if let Some(toolpath) = &mut files.toolpath {
            let name = self.folder.join(TOOLPATH);
            let reader = PathReader::open(toolpath.readable()?);
            let mut reader = reader.map_err(|error| error.named(&name))?;
            let played = PlayedPath {
                recipe: &job.recipe,
                touch: &job.preparation.touch,
                shape: job.shape(),
                largest_error: outcome.figures.playback.max(),
                points: self.rows,
            };
            let drawn = draw(plots, &played, &mut reader, observer)?;
            files.drafts.extend(drawn);
        }
        Ok(())
    }

    /// Gives the files their names. The summary comes last, so that where it is, all files are.
    pub fn complete(mut self, summary: &str) -> Result<Vec<PathBuf>, FileError> {
        let path = self.folder.join(SUMMARY);
        let mut draft = Draft::begin(&path)?;
        draft
            .write_all(summary.as_bytes())
            .map_err(|error| FileError { path, error })?;
        let mut written = Vec::new();
        if let Some(files) = &mut self.files {
            for draft in files.drafts.drain(..) {
                written.push(draft.complete()?);
            }
            if let Some(toolpath) = files.toolpath.take() {
                written.push(toolpath.complete()?);
            }
        }
        written.push(draft.complete()?);
        Ok(written)
    }
}

/// A file where a folder must be, or anything but a file where one must be, is refused before the
/// work.
fn nothing_in_the_way<'a>(
    folder: &Path,
    files: impl Iterator<Item = &'a str>,
) -> Result<(), FileError> {
    let nearest = folder.ancestors().find(|part| part.exists());
    if let Some(file) = nearest.filter(|part| !part.is_dir()) {
        let cause = format!("{} is a file, not a folder", file.display());
        return Err(FileError {
            path: folder.to_owned(),
            error: io::Error::new(io::ErrorKind::NotADirectory, cause),
        });
    }
    for file in files.map(|name| folder.join(name)) {
        Draft::can_be(&file)?;
    }
    Ok(())
}

impl Sink for FolderSink<'_> {
    type Block = FileBlock;
    type Error = SinkError;

    fn expect(&mut self, expected: &Estimate) -> Result<(), SinkError> {
        let programs = self.programs.iter();
        let programs = programs.map(|program| program.expected_bytes(self.radius, expected));
        let toolpath = if self.writes_toolpath {
            toolpath_bytes(expected)
        } else {
            0.0
        };
        check_room(&self.folder, toolpath + programs.sum::<f64>())?;
        Ok(())
    }

    fn encode(&self, block: &SectionBlock<'_>) -> Result<FileBlock, SinkError> {
        let rows = self
            .writes_toolpath
            .then(|| PathWriter::rows(block.section, block.points));
        let rows = rows.transpose().map_err(|error| FileError {
            path: self.folder.join(TOOLPATH),
            error,
        })?;
        let lines = self.programs.iter().map(|program| program.lines(block));
        Ok(FileBlock {
            rows,
            lines: lines.collect::<Result<_, _>>()?,
        })
    }

    fn take(&mut self, points: usize, block: FileBlock) -> Result<(), SinkError> {
        if self.files.is_none() {
            self.files = Some(self.begin()?);
        }
        self.rows += points as u64;
        let Some(files) = &mut self.files else {
            return Ok(());
        };
        let not_written = |name: &str, error| FileError {
            path: self.folder.join(name),
            error,
        };
        if let Some((toolpath, rows)) = files.toolpath.as_mut().zip(block.rows) {
            let appended = toolpath.append(&rows);
            appended.map_err(|error| not_written(TOOLPATH, error))?;
        }
        let programs = self.programs.iter().zip(&mut files.programs);
        for ((program, writer), lines) in programs.zip(&block.lines) {
            let appended = writer.append(points, lines);
            appended.map_err(|error| not_written(&program.file, error))?;
        }
        Ok(())
    }
}

impl Drop for Files {
    /// Of a run that failed nothing stays, nor the folders that were made for it.
    fn drop(&mut self) {
        self.toolpath = None;
        self.programs.clear();
        self.drafts.clear();
        for folder in &self.new_folders {
            // A folder stays where something else has come into it meanwhile, the result itself
            // among it.
            let _ = fs::remove_dir(folder);
        }
    }
}
