//! `ablation.json` and `ablation.csv`.

use std::io::Write;
use std::path::{Path, PathBuf};

use turnpath_files::{FileError, FolderError, ResultFolder, WholeFile};
use turnpath_report::comparison::csv_table;
use turnpath_report::{AblationReport, to_json};

use crate::error::Error;

const JSON: &str = "ablation.json";
const CSV: &str = "ablation.csv";

/// The files of an ablation.
pub struct AblationFiles {
    folder: ResultFolder,
}

impl AblationFiles {
    /// Makes the folder and claims it, so that a folder that takes no files is refused before
    /// the work.
    pub fn new(folder: &Path) -> Result<Self, FolderError> {
        for name in [JSON, CSV] {
            ResultFolder::can_have(folder, name)?;
        }
        let folder = ResultFolder::open(folder)?;
        Ok(Self { folder })
    }

    /// The folder.
    pub fn folder(&self) -> &ResultFolder {
        &self.folder
    }

    /// Writes both files, which get their names together; gives their paths.
    pub fn write(self, report: &AblationReport) -> Result<Vec<PathBuf>, Error> {
        let table = csv_table(&report.runs).map_err(|error| Error::Report {
            form: CSV,
            source: error.into(),
        })?;
        let csv = self.whole(CSV, &table)?;
        let json = self.whole(JSON, to_json(report).as_bytes())?;
        let paths = vec![json.path().to_owned(), csv.path().to_owned()];
        self.folder.commit(vec![csv], json)?;
        Ok(paths)
    }

    fn whole(&self, name: &str, bytes: &[u8]) -> Result<WholeFile, FileError> {
        let mut draft = self.folder.draft(&self.folder.path().join(name))?;
        let written = draft.write_all(bytes);
        written.map_err(FileError::of(draft.path()))?;
        draft.finish()
    }
}
