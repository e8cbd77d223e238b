//! `ablation.json` and `ablation.csv`.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use turnpath_post::{Draft, FileError};
use turnpath_report::comparison::csv_table;
use turnpath_report::{AblationReport, to_json};

use crate::error::Error;

const JSON: &str = "ablation.json";
const CSV: &str = "ablation.csv";

/// The files of an ablation.
pub struct AblationFiles {
    folder: PathBuf,
}

impl AblationFiles {
    /// Makes the folder, and begins the files, so that a folder that takes none is refused before
    /// the work.
    pub fn new(folder: &Path) -> Result<Self, FileError> {
        fs::create_dir_all(folder).map_err(|error| FileError {
            path: folder.to_owned(),
            error,
        })?;
        for name in [JSON, CSV] {
            drop(Draft::begin(folder.join(name))?);
        }
        let folder = folder.to_owned();
        Ok(Self { folder })
    }

    /// Writes both files; gives their paths.
    pub fn write(&self, report: &AblationReport) -> Result<Vec<PathBuf>, Error> {
        let table = csv_table(&report.runs).map_err(|error| Error::Report {
            form: CSV,
            source: error.into(),
        })?;
        let csv = write(self.folder.join(CSV), &table)?;
        let json = write(self.folder.join(JSON), to_json(report).as_bytes())?;
        Ok(vec![json, csv])
    }
}

fn write(path: PathBuf, bytes: &[u8]) -> Result<PathBuf, FileError> {
    let mut draft = Draft::begin(&path)?;
    match draft.write_all(bytes) {
        Ok(()) => draft.complete(),
        Err(error) => Err(FileError { path, error }),
    }
}
