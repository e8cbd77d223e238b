//! Records of finished runs: a file each, named by the run's key, there only when whole.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use turnpath_post::{Draft, FileError};

use crate::failure::Failure;
use crate::summary::to_json;

use super::key::{Key, hex};
use super::one::Made;

/// The folder of records in the output folder.
const RUNS: &str = "runs";
/// A record that is begun and left.
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
    made: Made,
    /// SHA-256 of `made`, so that damage shows.
    sha256: String,
}

impl Records {
    /// Makes the folder, if it is not there, and looks whether it takes a record.
    pub fn ready(output: &Path) -> Result<Self, FileError> {
        let folder = output.join(RUNS);
        let made = fs::create_dir_all(&folder);
        let made = made.and_then(|()| match Draft::begin(folder.join(PROBE)) {
            Ok(_) => Ok(()),
            Err(refused) => Err(refused.error),
        });
        match made {
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

    /// The run of this key, if its record is there and whole. A damaged one is told.
    pub fn take_over(&self, key: &Key) -> Option<Made> {
        let path = self.path(key);
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
            text => text.map_err(|error| error.to_string()),
        };
        match text.and_then(|text| whole(&text, key)) {
            Ok(made) => Some(made),
            Err(why) => {
                let name = path.display();
                eprintln!("note: {name} is damaged ({why}); its run is made again");
                None
            }
        }
    }

    /// Keeps a finished run.
    pub fn keep(&self, key: &Key, made: &Made) -> Result<(), Failure> {
        let path = self.path(key);
        let record = Record {
            key: key.hash.clone(),
            of: key.of.clone(),
            sha256: checksum(made),
            made: made.clone(),
        };
        let mut draft = Draft::begin(&path)?;
        let written = draft.write_all(to_json(&record).as_bytes());
        written.map_err(|error| FileError { path, error })?;
        draft.complete()?;
        Ok(())
    }
}

/// The run of a record's text, or what is wrong with it.
fn whole(text: &str, key: &Key) -> Result<Made, String> {
    let record: Record = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if record.key != key.hash {
        return Err("it is of another run".to_owned());
    }
    if record.sha256 != checksum(&record.made) {
        return Err("its figures have changed".to_owned());
    }
    Ok(record.made)
}

fn checksum(made: &Made) -> String {
    hex(&Sha256::digest(to_json(made).as_bytes()))
}
