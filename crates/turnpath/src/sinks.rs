//! What can go wrong between a path and its outputs, and the output that keeps nothing.

use std::convert::Infallible;

use turnpath_core::toolpath::SectionBlock;
use turnpath_files::FileError;
use turnpath_pipeline::{DraftSink, RunError, Sink};
use turnpath_recipe::Recipe;

use crate::diagnosis::{not_carried, of_pipeline};
use crate::error::Error;
use crate::posts::NotCarried;

/// Why an output could not take a block.
#[derive(Debug)]
pub enum SinkError {
    /// A program cannot carry the path.
    Program(NotCarried),
    /// A file could not be written.
    File(FileError),
}

impl From<NotCarried> for SinkError {
    fn from(error: NotCarried) -> Self {
        Self::Program(error)
    }
}

impl From<FileError> for SinkError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<Infallible> for SinkError {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}

/// An error of a run, with its place in the recipe where it has one.
pub fn of_run<E: Into<SinkError>>(recipe: &Recipe, error: RunError<E>) -> Error {
    match error {
        RunError::Pipeline(error) => of_pipeline(recipe, error),
        RunError::Sink(error) => match error.into() {
            SinkError::Program(error) => not_carried(recipe, error),
            SinkError::File(error) => error.into(),
        },
    }
}

/// Counts the rows of a path and keeps nothing of it.
#[derive(Debug, Default)]
pub struct RowCount {
    /// Control points of all sections.
    pub rows: u64,
}

impl Sink for RowCount {
    type Block = ();
    type Error = Infallible;

    fn encode(&self, _: &SectionBlock<'_>) -> Result<(), Infallible> {
        Ok(())
    }

    fn take(&mut self, points: usize, (): ()) -> Result<(), Infallible> {
        self.rows += points as u64;
        Ok(())
    }
}

impl DraftSink for RowCount {
    fn drop_draft(&mut self) {
        self.rows = 0;
    }
}
