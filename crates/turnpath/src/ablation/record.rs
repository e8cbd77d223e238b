//! Records of finished runs: a file each, named by the run's key, complete as soon as it is there.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use turnpath_files::{Draft, FileError, ResultFolder, read_bounded_text};
use turnpath_host::sha256_hex;
use turnpath_report::{MeasuredRun, to_json};

use crate::error::Error;
use crate::summary::MOST_BYTES;

use super::key::Key;
use super::observer::AblationObserver;

/// The folder of records in the output folder.
const RUNS: &str = "runs";
/// A record that is begun and given up, to see whether the folder takes one.
const PROBE: &str = "probe";

/// The records of an output folder.
pub struct Records {
    folder: PathBuf,
}

/// What stands in a record.
#[derive(Debug, Serialize, Deserialize)]
struct Record {
    key: String,
    /// What the key is the hash of.
    of: Value,
    run: MeasuredRun,
    /// SHA-256 of `run`, so that damage shows.
    sha256: String,
}

impl Records {
    /// Makes the folder, if it is not there, and tries whether it takes a record.
    pub fn new(output: &ResultFolder) -> Result<Self, FileError> {
        let folder = output.path().join(RUNS);
        let usable = fs::create_dir_all(&folder);
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
    pub fn read(&self, key: &Key, observer: &dyn AblationObserver) -> Option<MeasuredRun> {
        let path = self.path(key);
        let text = match read_bounded_text(&path, MOST_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
            text => text.map_err(|error| error.to_string()),
        };
        match text.and_then(|text| whole(&text, key)) {
            Ok(run) => Some(run),
            Err(why) => {
                observer.damaged(&path, &why);
                None
            }
        }
    }

    /// Keeps a finished run.
    pub fn keep(&self, output: &ResultFolder, key: &Key, run: &MeasuredRun) -> Result<(), Error> {
        let path = self.path(key);
        let record = Record {
            key: key.hash.clone(),
            of: key.of.clone(),
            sha256: checksum(run),
            run: run.clone(),
        };
        let mut draft = output.draft_alone(&path)?;
        let written = draft.write_all(to_json(&record).as_bytes());
        written.map_err(|error| FileError { path, error })?;
        draft.complete()?;
        Ok(())
    }
}

/// The run of a record's text, or what is wrong with it.
fn whole(text: &str, key: &Key) -> Result<MeasuredRun, String> {
    let record: Record = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if record.key != key.hash {
        return Err("it is of another run".to_owned());
    }
    if record.sha256 != checksum(&record.run) {
        return Err("its figures have changed".to_owned());
    }
    Ok(record.run)
}

fn checksum(run: &MeasuredRun) -> String {
    sha256_hex(to_json(run).as_bytes())
}
