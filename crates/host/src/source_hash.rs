//! The SHA-256 of what a plugin comes from.

use std::fmt;
use std::fs::File;
use std::io::{self, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use crate::hash::{sha256_hex, sha256_hex_of_reader};

/// The SHA-256 of the bytes that a plugin comes from, in lower-case hexadecimal. That of a library is
/// calculated when it is first asked for: a run loads all libraries of a folder, and uses few of
/// them. Libraries of large folders are hashed as they are read.
#[derive(Clone)]
pub struct SourceHash(Arc<Source>);

enum Source {
    /// The hash is known.
    Known {
        hex: String,
        /// How many bytes were hashed, if that is known too.
        bytes: Option<u64>,
    },
    /// The bytes are there to be hashed.
    Copy {
        /// The library's own file, for messages.
        path: PathBuf,
        bytes: u64,
        /// The private copy of the library, which may have no name any more.
        copy: File,
        hex: OnceLock<io::Result<String>>,
    },
}

/// The copy of a library cannot be read, so that its hash cannot be calculated.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}", path.display())]
pub struct HashError {
    /// The library's own file.
    pub path: PathBuf,
    /// The system's reason.
    pub source: io::Error,
}

impl SourceHash {
    /// A hash that is known.
    pub fn known(hex: impl Into<String>) -> Self {
        let hex = hex.into();
        Self(Arc::new(Source::Known { hex, bytes: None }))
    }

    /// The hash of these bytes.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        Self(Arc::new(Source::Known {
            hex: sha256_hex(bytes),
            bytes: Some(bytes.len() as u64),
        }))
    }

    /// The hash of a library at `path`, whose bytes are in this copy.
    ///
    /// # Errors
    /// When the system does not say how long the copy is.
    pub(crate) fn of_copy(path: PathBuf, copy: File) -> io::Result<Self> {
        let bytes = copy.metadata()?.len();
        Ok(Self(Arc::new(Source::Copy {
            path,
            bytes,
            copy,
            hex: OnceLock::new(),
        })))
    }

    /// The hash.
    ///
    /// # Errors
    /// When the copy of the library cannot be read.
    pub fn hex(&self) -> Result<&str, HashError> {
        match &*self.0 {
            Source::Known { hex, .. } => Ok(hex),
            Source::Copy {
                path, copy, hex, ..
            } => {
                let hex = hex.get_or_init(|| of_whole_file(copy)).as_deref();
                hex.map_err(|error| HashError {
                    path: path.clone(),
                    source: io::Error::new(error.kind(), format!("its private copy: {error}")),
                })
            }
        }
    }

    /// Whether the bytes are the same. Only bytes of the same number are hashed.
    ///
    /// # Errors
    /// Those of [`hex`](Self::hex).
    pub(crate) fn is_of_same_bytes(&self, other: &Self) -> Result<bool, HashError> {
        if Arc::ptr_eq(&self.0, &other.0) {
            return Ok(true);
        }
        match (self.bytes(), other.bytes()) {
            (Some(one), Some(two)) if one != two => Ok(false),
            _ => Ok(self.hex()? == other.hex()?),
        }
    }

    fn bytes(&self) -> Option<u64> {
        match &*self.0 {
            Source::Known { bytes, .. } => *bytes,
            Source::Copy { bytes, .. } => Some(*bytes),
        }
    }
}

fn of_whole_file(mut file: &File) -> io::Result<String> {
    file.seek(SeekFrom::Start(0))?;
    sha256_hex_of_reader(file)
}

/// The hash, if it is known.
impl fmt::Debug for SourceHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hex = match &*self.0 {
            Source::Known { hex, .. } => Some(hex),
            Source::Copy { hex, .. } => hex.get().and_then(|hex| hex.as_ref().ok()),
        };
        f.debug_tuple("SourceHash").field(&hex).finish()
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn of_copy(bytes: &[u8]) -> SourceHash {
        let mut copy = tempfile::tempfile().unwrap();
        copy.write_all(bytes).unwrap();
        SourceHash::of_copy("lib.so".into(), copy).unwrap()
    }

    #[test]
    fn the_hash_of_a_copy_is_that_of_its_bytes() {
        for bytes in [&b""[..], b"abc", &[7; 100_000]] {
            assert_eq!(of_copy(bytes).hex().unwrap(), sha256_hex(bytes));
        }
    }

    #[test]
    fn the_same_bytes_have_one_hash_wherever_it_comes_from() {
        let hex = sha256_hex(b"abc");
        let same = [
            SourceHash::known(&hex),
            SourceHash::of(b"abc"),
            of_copy(b"abc"),
        ];
        let others = [SourceHash::of(b"abd"), of_copy(b"ab"), of_copy(b"abd")];
        for one in &same {
            assert!(
                same.iter()
                    .all(|other| one.is_of_same_bytes(other).unwrap())
            );
            assert!(
                others
                    .iter()
                    .all(|other| !one.is_of_same_bytes(other).unwrap())
            );
        }
    }

    #[test]
    fn copies_of_other_lengths_are_told_apart_without_a_hash() {
        let (short, long) = (of_copy(b"ab"), of_copy(b"abc"));
        assert!(!short.is_of_same_bytes(&long).unwrap());
        for hash in [short, long] {
            assert!(matches!(&*hash.0, Source::Copy { hex, .. } if hex.get().is_none()));
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_copy_without_a_name_can_still_be_hashed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("copy");
        std::fs::write(&path, "abc").unwrap();
        let hash = SourceHash::of_copy("lib.so".into(), File::open(&path).unwrap()).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(hash.hex().unwrap(), sha256_hex(b"abc"));
    }
}
