//! The files of a run: begun with its first control points, named when all is done.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::SectionBlock;
use turnpath_pipeline::{Outcome, Sink};
use turnpath_post::{Draft, FileError, PathReader, PathWriter, PmacWriter};

use crate::failure::Failure;
use crate::job::Job;
use crate::plots::Wishes;
use crate::plotting::{Played, plot};
use crate::programs::Program;
use crate::progress::Bar;
use crate::summary::ProgramSummary;

/// Names of the files in the output folder.
const TOOLPATH: &str = "toolpath.csv";
const SUMMARY: &str = "summary.json";

/// The files of a run, begun with its first control points, so that a run which fails before
/// leaves nothing behind.
pub struct Files {
    folder: PathBuf,
    wants_path: bool,
    programs: Vec<Program>,
    begun: Option<Begun>,
    /// Rows of the path, all sections together.
    pub rows: u64,
}

#[derive(Default)]
struct Begun {
    /// Folders that were made for the files, the deepest first.
    made: Vec<PathBuf>,
    path: Option<PathWriter>,
    programs: Vec<PmacWriter>,
    /// Programs that are whole, and still without their names.
    whole: Vec<Draft>,
}

impl Files {
    /// # Errors
    /// When something is in the way that would stop the run only at its end.
    pub fn new(
        folder: PathBuf,
        wants_path: bool,
        programs: Vec<Program>,
    ) -> Result<Self, FileError> {
        let names = programs.iter().map(|program| program.file.as_str());
        nothing_in_the_way(&folder, names.chain([TOOLPATH, SUMMARY]))?;
        Ok(Self {
            folder,
            wants_path,
            programs,
            begun: None,
            rows: 0,
        })
    }

    fn begin(&mut self) -> Result<(), FileError> {
        let missing = self.folder.ancestors();
        let missing = missing.take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let made = missing.map(Path::to_owned).collect();
        let folder = |error| FileError {
            path: self.folder.clone(),
            error,
        };
        fs::create_dir_all(&self.folder).map_err(folder)?;
        // From here on the folders are removed again if anything fails.
        let begun = self.begun.insert(Begun {
            made,
            ..Begun::default()
        });
        if self.wants_path {
            begun.path = Some(PathWriter::begin(self.folder.join(TOOLPATH))?);
        }
        for program in &self.programs {
            begun.programs.push(program.begin(&self.folder)?);
        }
        Ok(())
    }

    /// Puts the programs together, reads each back and measures it on its own text.
    pub fn read_back(
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

    /// Maps, profiles and circles of `toolpath.csv` as it stands.
    pub fn plot(
        &mut self,
        job: &Job,
        wishes: &Wishes,
        outcome: &Outcome,
        bar: &Bar,
    ) -> Result<(), Failure> {
        let Some(begun) = self.begun.as_mut().filter(|_| !wishes.is_empty()) else {
            return Ok(());
        };
        if let Some(path) = &mut begun.path {
            let name = self.folder.join(TOOLPATH);
            let reader = PathReader::open(path.readable()?);
            let mut reader = reader.map_err(|error| error.named(&name))?;
            let played = Played {
                recipe: &job.recipe,
                touch: &job.prepared.touch,
                shape: job.chain.velocity.strategy.segments(),
                largest_error: outcome.figures.playback.max(),
                points: self.rows,
            };
            begun.whole.extend(plot(wishes, &played, &mut reader, bar)?);
        }
        Ok(())
    }

    /// Gives the files their names; the summary comes last, so that where it is, all is.
    pub fn complete(mut self, summary: &str) -> Result<Vec<PathBuf>, FileError> {
        let path = self.folder.join(SUMMARY);
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

/// A file where a folder must be, or anything but a file where one must be, is told before the
/// work.
fn nothing_in_the_way<'a>(
    folder: &Path,
    files: impl Iterator<Item = &'a str>,
) -> Result<(), FileError> {
    let nearest = folder.ancestors().find(|part| part.exists());
    if let Some(file) = nearest.filter(|part| !part.is_dir()) {
        let what = format!("{} is a file, not a folder", file.display());
        return Err(FileError {
            path: folder.to_owned(),
            error: io::Error::new(io::ErrorKind::NotADirectory, what),
        });
    }
    for file in files.map(|name| folder.join(name)) {
        Draft::can_be(&file)?;
    }
    Ok(())
}

impl Sink for Files {
    fn encode(&self, stretch: &SectionBlock<'_>) -> io::Result<Vec<Vec<u8>>> {
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
            self.begin().map_err(io::Error::other)?;
        }
        self.rows += points as u64;
        let Some(begun) = &mut self.begun else {
            return Ok(());
        };
        let mut encoded = encoded.iter();
        if let Some((path, rows)) = begun.path.as_mut().zip(encoded.as_slice().first()) {
            path.append(rows).map_err(|error| {
                let path = self.folder.join(TOOLPATH);
                io::Error::other(FileError { path, error })
            })?;
            encoded.next();
        }
        for (program, lines) in begun.programs.iter_mut().zip(encoded) {
            program.append(points, lines)?;
        }
        Ok(())
    }
}

impl Drop for Files {
    /// Of a run that failed nothing stays, its folders neither if it made them.
    fn drop(&mut self) {
        if let Some(mut begun) = self.begun.take() {
            let made = std::mem::take(&mut begun.made);
            drop(begun);
            for folder in made {
                // One is left where something else has come into it meanwhile.
                let _ = fs::remove_dir(folder);
            }
        }
    }
}
