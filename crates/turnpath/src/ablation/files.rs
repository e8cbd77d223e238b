//! `ablation.json`, `ablation.csv` and `report.html`.

use std::io::Write;
use std::path::{Path, PathBuf};

use turnpath_files::{FileError, FolderError, ResultFolder, WholeFile};
use turnpath_page::{AblationPage, ablation_page};
use turnpath_report::comparison::csv_table;
use turnpath_report::{AblationReport, to_json};

use crate::error::Error;
use crate::summary::{ABLATION as JSON, PAGE};

const CSV: &str = "ablation.csv";

/// The files of an ablation.
pub struct AblationFiles {
    folder: ResultFolder,
}

impl AblationFiles {
    /// Makes the folder and claims it, so that a folder that takes no files is refused before
    /// the work.
    pub fn new(folder: &Path) -> Result<Self, FolderError> {
        for name in [JSON, CSV, PAGE] {
            ResultFolder::can_have(folder, name)?;
        }
        let folder = ResultFolder::open(folder)?;
        Ok(Self { folder })
    }

    /// The folder.
    pub fn folder(&self) -> &ResultFolder {
        &self.folder
    }

    /// Writes the files, which get their names together; gives their paths.
    pub fn write(self, report: &AblationReport) -> Result<Vec<PathBuf>, Error> {
        let table = csv_table(&report.runs).map_err(|error| Error::Report {
            form: CSV,
            source: error.into(),
        })?;
        let csv = self.whole(CSV, &table)?;
        let json = self.whole(JSON, to_json(report).as_bytes())?;
        let page = ablation_page(&AblationPage {
            report: report.clone(),
        });
        let page = self.whole(PAGE, page.as_bytes())?;
        let paths = [&json, &csv, &page].map(|file| file.path().to_owned());
        let paths = paths.to_vec();
        self.folder.commit(vec![csv, page], json)?;
        Ok(paths)
    }

    fn whole(&self, name: &str, bytes: &[u8]) -> Result<WholeFile, FileError> {
        let mut draft = self.folder.draft(&self.folder.path().join(name))?;
        let written = draft.write_all(bytes);
        written.map_err(FileError::of(draft.path()))?;
        draft.finish()
    }
}
