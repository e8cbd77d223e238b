//! Files of heights on a grid: CSV, `.gsf` and Zemax `.DAT`.

use std::io;
use std::path::Path;

use turnpath_files::{Draft, FileError};
use turnpath_post::{GridPoints, GsfWriter, ZemaxWriter};

/// The form of a file of heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GridForm {
    /// Lines of numbers.
    Csv,
    /// Gwyddion Simple Field.
    Gsf,
    /// Zemax grid sag.
    Zemax,
}

impl GridForm {
    /// The form that the ending of a file's name asks for.
    pub fn of(file: &Path) -> Self {
        let ending = file.extension().unwrap_or_default();
        match ending.to_string_lossy().to_ascii_lowercase().as_str() {
            "gsf" => Self::Gsf,
            "dat" => Self::Zemax,
            _ => Self::Csv,
        }
    }
}

/// A file of heights that is written row by row, from the upper one down.
pub enum GridWriter {
    Gsf(GsfWriter),
    Zemax(ZemaxWriter),
}

impl GridWriter {
    /// Begins a file of this form; `None` for CSV, whose columns differ.
    pub fn begin(
        form: GridForm,
        file: &Path,
        title: &str,
        points: &GridPoints,
    ) -> Result<Option<Self>, FileError> {
        let draft = || Draft::begin(file);
        Ok(match form {
            GridForm::Csv => None,
            GridForm::Gsf => Some(Self::Gsf(GsfWriter::at_points(draft()?, title, points)?)),
            GridForm::Zemax => Some(Self::Zemax(ZemaxWriter::begin(draft()?, points)?)),
        })
    }

    /// Writes the next row, mm.
    pub fn row(&mut self, values: impl Iterator<Item = f64>) -> Result<(), FileError> {
        match self {
            Self::Gsf(writer) => writer.row(values),
            Self::Zemax(writer) => writer.row(values),
        }
    }

    /// Gives the file its name.
    pub fn complete(self) -> Result<(), FileError> {
        let draft = match self {
            Self::Gsf(writer) => writer.whole(),
            Self::Zemax(writer) => writer.whole(),
        };
        draft.complete().map(drop)
    }
}

/// The error of a CSV file that takes no more, as the system gave it.
pub fn not_written(file: &Path, error: impl Into<csv::Error>) -> FileError {
    let error = error.into();
    let error = match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    };
    FileError {
        path: file.to_owned(),
        error,
    }
}
