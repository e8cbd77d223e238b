//! A path that is made and written, and never measured: what the chain alone costs.

use std::io::Write;
use std::path::Path;

use turnpath_core::toolpath::SectionBlock;
use turnpath_files::FileError;
use turnpath_pipeline::{Observer, PathOptions, Sink, make_unmeasured};
use turnpath_post::Lines;

use crate::error::Error;
use crate::job::Job;
use crate::program::Program;
use crate::sinks::{SinkError, of_run};

impl Job {
    /// Makes the path without refinement, and writes the lines of its programs. Nothing is measured,
    /// so the file is none to cut with: it lacks the programs' frames. Gives the control points.
    ///
    /// # Errors
    /// As [`Job::run`].
    pub fn write_unmeasured(
        &self,
        file: &Path,
        output: &mut (dyn Write + Send + Sync),
        observer: &dyn Observer,
    ) -> Result<u64, Error> {
        let mut sink = LineSink {
            programs: &self.programs,
            file,
            output,
            points: 0,
        };
        let options = PathOptions {
            refine: false,
            ..self.options()
        };
        let preparation = self.path_preparation();
        make_unmeasured(&self.chain, &preparation, options, &mut sink, observer)
            .map_err(|error| of_run(&self.recipe, error))?;
        Ok(sink.points)
    }
}

/// Writes the lines of programs one block after the other.
struct LineSink<'a> {
    programs: &'a [Program],
    /// The output's name, for messages.
    file: &'a Path,
    output: &'a mut (dyn Write + Send + Sync),
    points: u64,
}

impl Sink for LineSink<'_> {
    type Block = Vec<Lines>;
    type Error = SinkError;

    fn encode(&self, block: &SectionBlock<'_>) -> Result<Vec<Lines>, SinkError> {
        let lines = self.programs.iter().map(|program| program.lines(block));
        Ok(lines.collect::<Result<_, _>>()?)
    }

    fn take(&mut self, points: usize, block: Vec<Lines>) -> Result<(), SinkError> {
        self.points += points as u64;
        for lines in block {
            let written = self.output.write_all(&lines.text);
            written.map_err(FileError::of(self.file))?;
        }
        Ok(())
    }
}
