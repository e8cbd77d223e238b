//! The data files that recipes name: each is read once and hashed.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use turnpath_host::sha256_hex;

/// Largest data file. A map of 4096 × 4096 points takes 700 MB as `.xyz`, the longest of its formats.
/// While a strategy is made, the bytes of its files are in memory three times.
const MOST_BYTES: u64 = 1 << 30;

/// The contents of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contents {
    /// The bytes.
    pub bytes: Arc<[u8]>,
    /// Their SHA-256, in lower-case hexadecimal.
    pub sha256: String,
}

/// Why a data file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DataFileError {
    /// There is none.
    #[error("there is no such file")]
    Missing,
    /// It is a folder.
    #[error("it is a folder")]
    Folder,
    /// It is neither a file nor a folder: a device or a pipe may never end.
    #[error("it is not a file")]
    Special,
    /// It is larger than any data file.
    #[error("it is larger than {} MiB, the most that a data file may have", MOST_BYTES >> 20)]
    TooLarge,
    /// The system could not read it.
    #[error(transparent)]
    Io(io::Error),
}

impl From<io::Error> for DataFileError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Self::Missing,
            io::ErrorKind::IsADirectory => Self::Folder,
            _ => Self::Io(error),
        }
    }
}

/// The data files that were read so far. Clones share them.
#[derive(Debug, Clone, Default)]
pub struct DataFiles(Arc<Mutex<BTreeMap<PathBuf, Contents>>>);

impl DataFiles {
    /// The contents of a file, which is read only once.
    ///
    /// # Errors
    /// When there is no such file, or it cannot be read or is too large.
    pub fn read(&self, path: &Path) -> Result<Contents, DataFileError> {
        // Of a file there is one copy, whatever path leads to it.
        let path = &fs::canonicalize(path)?;
        // A panic while the lock is held leaves a valid map: each file in it is whole.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(contents) = known.get(path) {
            return Ok(contents.clone());
        }
        let bytes = read(path)?;
        let contents = Contents {
            sha256: sha256_hex(&bytes),
            bytes: bytes.into(),
        };
        known.insert(path.to_owned(), contents.clone());
        Ok(contents)
    }

    /// The files that were read.
    pub fn paths(&self) -> Vec<PathBuf> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.keys().cloned().collect()
    }
}

fn read(path: &Path) -> Result<Vec<u8>, DataFileError> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(DataFileError::Folder);
    }
    if !metadata.is_file() {
        return Err(DataFileError::Special);
    }
    if metadata.len() > MOST_BYTES {
        return Err(DataFileError::TooLarge);
    }
    let mut bytes = Vec::new();
    let file = File::open(path)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(DataFileError::TooLarge);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.csv");
        fs::write(&path, "1,2").unwrap();
        let files = DataFiles::default();
        let first = files.read(&path).unwrap();
        assert_eq!(first.bytes[..], *b"1,2");
        assert_eq!(first.sha256, sha256_hex(b"1,2"));
        fs::write(&path, "3,4").unwrap();
        assert_eq!(files.clone().read(&path).unwrap(), first);
        let another_way = folder.path().join(".").join("map.csv");
        assert_eq!(files.read(&another_way).unwrap(), first);
        assert_ne!(DataFiles::default().read(&path).unwrap(), first);
    }

    /// The file has no bytes on the disk: only its length is looked at.
    #[test]
    fn a_file_above_the_limit_is_refused_before_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.csv");
        File::create(&path)
            .unwrap()
            .set_len(MOST_BYTES + 1)
            .unwrap();
        let error = DataFiles::default().read(&path).unwrap_err();
        assert!(
            error.to_string().contains("larger than 1024 MiB"),
            "{error}"
        );
    }

    #[test]
    fn what_is_no_file_is_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let files = DataFiles::default();
        let said = |name: &str| {
            let error = files.read(&folder.path().join(name)).unwrap_err();
            error.to_string()
        };
        assert_eq!(said("none.csv"), "there is no such file");
        assert_eq!(said(""), "it is a folder");
        #[cfg(unix)]
        {
            let error = files.read(Path::new("/dev/null")).unwrap_err();
            assert_eq!(error.to_string(), "it is not a file");
        }
    }
}
