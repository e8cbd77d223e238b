//! Writes `toolpath.csv`.

use std::io::{self, Write};
use std::path::Path;

use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_files::{Draft, FileError};

use crate::row::{HEADER, Row};

/// Writes `toolpath.csv` to a file or to memory.
///
/// ```
/// use turnpath_core::toolpath::{PathBlock, Section};
/// use turnpath_post::PathWriter;
///
/// let mut writer = PathWriter::in_memory();
/// writer.append(&PathWriter::rows(Section::Cutting, &PathBlock::default())?)?;
/// assert!(writer.into_bytes().starts_with(b"time_s,c_deg,"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct PathWriter<W = Draft> {
    output: W,
}

impl PathWriter {
    /// Begins the file with its first line.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(mut output: Draft) -> Result<Self, FileError> {
        match output.write_all(first_line().as_bytes()) {
            Ok(()) => Ok(Self { output }),
            Err(error) => Err(FileError {
                path: output.path().to_owned(),
                error,
            }),
        }
    }

    /// Control points as rows. This needs no file, so several blocks can be formatted in parallel.
    ///
    /// # Errors
    /// When a row cannot be formatted.
    pub fn rows(section: Section, points: &PathBlock) -> io::Result<Vec<u8>> {
        let mut rows = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
        for point in points.points() {
            rows.serialize(Row::new(&point, section))?;
        }
        rows.into_inner().map_err(csv::IntoInnerError::into_error)
    }

    /// Everything written so far, as a file that can be read under a temporary name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn readable(&mut self) -> Result<&Path, FileError> {
        self.output.readable()
    }

    /// The complete file, still without its name.
    pub fn whole(self) -> Draft {
        self.output
    }
}

impl PathWriter<Vec<u8>> {
    /// Begins in memory, with the first line.
    pub fn in_memory() -> Self {
        let output = first_line().into_bytes();
        Self { output }
    }

    /// The bytes of the whole file.
    pub fn into_bytes(self) -> Vec<u8> {
        self.output
    }
}

impl<W: Write> PathWriter<W> {
    /// Appends rows.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, rows: &[u8]) -> io::Result<()> {
        self.output.write_all(rows)
    }
}

fn first_line() -> String {
    format!("{}\n", HEADER.join(","))
}
