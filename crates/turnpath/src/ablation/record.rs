//! Records of runs: a file each, named by the run's key, complete as soon as it is there.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use turnpath_files::{Draft, FileError, ResultFolder, read_bounded_text, remove_stale_drafts};
use turnpath_host::sha256_hex;
use turnpath_report::{FailedRun, MeasuredRun, to_json};

use crate::error::Error;
use crate::summary::MOST_BYTES;

use super::key::Key;
use super::observer::AblationObserver;

/// The folder of records in the output folder.
const RUNS: &str = "runs";
/// A record that is begun and given up, to see whether the folder takes one.
const PROBE: &str = "probe";

/// From this age on a draft among the records is that of a killed process. A record is written in
/// milliseconds; the clocks of a queue's machines may differ by minutes.
const STALE: Duration = Duration::from_secs(3600);

/// The records of an output folder.
pub struct Records {
    folder: PathBuf,
}

/// What stands in a record of a run.
#[derive(Debug, Serialize, Deserialize)]
struct Record<R> {
    key: String,
    /// What the key is the hash of.
    of: Value,
    run: R,
    /// SHA-256 of `run`, so that damage shows.
    sha256: String,
    /// Whether the run was begun and nothing more.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    begun: bool,
}

/// What is known of a run.
pub enum RunRecord {
    /// It was made.
    Measured(Box<MeasuredRun>),
    /// It was tried alone and failed; nothing but a new try tells whether it does so again.
    Failed(FailedRun),
    /// It was begun alone: it is being made, or its process ended before it did.
    Begun(FailedRun),
    /// There is no record, or a damaged one.
    None,
}

impl Records {
    /// The records below an output folder, which need not be there.
    pub fn of(output: &Path) -> Self {
        Self {
            folder: output.join(RUNS),
        }
    }

    /// Makes the folder, if it is not there, and tries whether it takes a record.
    pub fn make(output: &Path) -> Result<Self, FileError> {
        let folder = output.join(RUNS);
        let usable = fs::create_dir_all(&folder);
        remove_stale_drafts(&folder, STALE);
        let usable = usable.and_then(|()| {
            let draft = Draft::begin(folder.join(PROBE));
            draft.map(drop).map_err(|refused| refused.error)
        });
        match usable {
            Ok(()) => Ok(Self { folder }),
            Err(error) => Err(FileError {
                path: folder,
                error,
            }),
        }
    }

    fn path(&self, key: &Key) -> PathBuf {
        self.folder.join(format!("{}.json", key.hash))
    }

    /// The run of this key, if its record is there and whole. The observer hears of a damaged one.
    pub fn read(&self, key: &Key, observer: &dyn AblationObserver) -> RunRecord {
        let path = self.path(key);
        let text = match read_bounded_text(&path, MOST_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return RunRecord::None,
            text => text.map_err(|error| error.to_string()),
        };
        let whole = text.and_then(|text| match whole::<FailedRun>(&text, key) {
            Ok(record) if record.begun => Ok(RunRecord::Begun(record.run)),
            Ok(record) => Ok(RunRecord::Failed(record.run)),
            Err(_) => whole(&text, key).map(|record| RunRecord::Measured(Box::new(record.run))),
        });
        whole.unwrap_or_else(|why| {
            observer.damaged(&path, &why);
            RunRecord::None
        })
    }

    /// Keeps a run that was made, or that failed.
    /// With a result folder that is being written, its draft goes with those of the folder.
    pub fn keep<R: Serialize>(
        &self,
        output: Option<&ResultFolder>,
        key: &Key,
        run: &R,
    ) -> Result<(), Error> {
        self.write(output, key, run, false)
    }

    /// Keeps that a run is begun. What is kept of it later takes the place of this, which stays only
    /// where the process ends before the run does; `run` says so.
    pub fn keep_begun(&self, key: &Key, run: &FailedRun) -> Result<(), Error> {
        self.write(None, key, run, true)
    }

    fn write<R: Serialize>(
        &self,
        output: Option<&ResultFolder>,
        key: &Key,
        run: &R,
        begun: bool,
    ) -> Result<(), Error> {
        let path = self.path(key);
        let record = Record {
            key: key.hash.clone(),
            of: key.of.clone(),
            sha256: checksum(run),
            run,
            begun,
        };
        let mut draft = match output {
            Some(output) => output.draft_alone(&path)?,
            None => Draft::begin(&path)?,
        };
        let written = draft.write_all(to_json(&record).as_bytes());
        written.map_err(|error| FileError { path, error })?;
        draft.complete()?;
        Ok(())
    }
}

/// The record of a text, or what is wrong with it.
fn whole<R: Serialize + DeserializeOwned>(text: &str, key: &Key) -> Result<Record<R>, String> {
    let record: Record<R> = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if record.key != key.hash {
        return Err("it is of another run".to_owned());
    }
    if record.sha256 != checksum(&record.run) {
        return Err("its figures have changed".to_owned());
    }
    Ok(record)
}

fn checksum<R: Serialize>(run: &R) -> String {
    sha256_hex(to_json(run).as_bytes())
}
