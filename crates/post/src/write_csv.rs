//! Writes `toolpath.csv`.

use std::io::{self, Write};
use std::path::PathBuf;

use turnpath_core::toolpath::{PathBlock, Section};

use crate::row::{HEADER, Row};
use crate::{Draft, FileError};

/// `toolpath.csv` in the making.
#[derive(Debug)]
pub struct PathWriter {
    draft: Draft,
}

impl PathWriter {
    /// Begins the file with its first line.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let mut draft = Draft::begin(path)?;
        match writeln!(draft, "{}", HEADER.join(",")) {
            Ok(()) => Ok(Self { draft }),
            Err(error) => Err(FileError {
                path: draft.path().to_owned(),
                error,
            }),
        }
    }

    /// Control points as rows; needs no file, so that blocks can be put into rows in parallel.
    pub fn rows(section: Section, points: &PathBlock) -> io::Result<Vec<u8>> {
        let mut rows = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
        for point in points.points() {
            rows.serialize(Row::new(&point, section))?;
        }
        rows.into_inner().map_err(csv::IntoInnerError::into_error)
    }

    /// Appends rows.
    pub fn append(&mut self, rows: &[u8]) -> io::Result<()> {
        self.draft.write_all(rows)
    }

    /// What has been written so far, as a file that can be read under another name.
    pub fn readable(&mut self) -> Result<&std::path::Path, FileError> {
        self.draft.readable()
    }

    /// The file is whole and takes its name.
    pub fn complete(self) -> Result<PathBuf, FileError> {
        self.draft.complete()
    }
}
