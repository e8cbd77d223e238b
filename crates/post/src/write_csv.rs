//! Writes `toolpath.csv`.

use std::io;
use std::path::PathBuf;

use turnpath_core::toolpath::{PathBlock, Section};

use crate::row::Row;
use crate::{Draft, FileError};

/// `toolpath.csv` in the making.
#[derive(Debug)]
pub struct PathWriter {
    rows: csv::Writer<Draft>,
    path: PathBuf,
    count: u64,
}

impl PathWriter {
    /// Begins the file.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let draft = Draft::begin(path)?;
        let path = draft.path().to_owned();
        Ok(Self {
            rows: csv::Writer::from_writer(draft),
            path,
            count: 0,
        })
    }

    /// Appends control points.
    pub fn write(&mut self, section: Section, points: &PathBlock) -> io::Result<()> {
        for point in points.points() {
            self.rows.serialize(Row::new(&point, section))?;
        }
        self.count += points.len() as u64;
        Ok(())
    }

    /// Rows so far, all sections together.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The file is whole and takes its name.
    pub fn complete(self) -> Result<PathBuf, FileError> {
        let path = self.path;
        match self.rows.into_inner() {
            Ok(draft) => draft.complete(),
            Err(error) => Err(FileError {
                path,
                error: error.into_error(),
            }),
        }
    }
}
