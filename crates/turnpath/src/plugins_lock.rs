//! The lock of plugins: which libraries may be loaded, by their SHA-256.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use turnpath_files::{Draft, FileError};
use turnpath_host::{Admission, Catalogue, LibraryFile, LoadError, Refusal};

use crate::Error;

/// The form of the file.
const FORMAT: u32 = 1;
/// Largest lock, in bytes: some thousand plugins.
const MOST_BYTES: u64 = 1 << 20;
/// What a lock begins with.
const HEAD: &str =
    "# Plugins that `--plugins-lock` lets a run load. `turnpath list --lock` writes this.\n";

/// The libraries that may be loaded. As an [`Admission`] it refuses all others, before any of their
/// code runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginsLock {
    /// The lock's file, for messages.
    path: PathBuf,
    entries: Vec<Entry>,
}

/// The text of a lock.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Contents {
    format: u32,
    #[serde(default, rename = "plugin")]
    plugins: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    version: String,
    /// The library's name without its folder, so that a lock serves on other machines too.
    file: String,
    sha256: String,
}

/// Why a lock cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PluginsLockError {
    /// The file could not be read.
    #[error("cannot read the plugins' lock {}", path.display())]
    Unreadable {
        /// The lock.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is a folder, a pipe or a device, or larger than any lock.
    #[error("{} is not a plugins' lock but {what}", path.display())]
    NotAFile {
        /// The lock.
        path: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// Its text is not that of a lock.
    #[error("{} is not a plugins' lock: {message}", path.display())]
    Wrong {
        /// The lock.
        path: PathBuf,
        /// What is wrong with it, with the line.
        message: String,
    },
}

impl PluginsLock {
    /// Reads a lock.
    ///
    /// # Errors
    /// When the file cannot be read, or is not a lock.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, PluginsLockError> {
        let path = path.as_ref();
        let text = read(path)?;
        let wrong = |message| PluginsLockError::Wrong {
            path: path.to_owned(),
            message,
        };
        let contents: Contents = toml::from_str(&text)
            .map_err(|error| wrong(error.to_string().trim_end().to_owned()))?;
        if contents.format != FORMAT {
            let format = contents.format;
            return Err(wrong(format!("its format is {format}, and not {FORMAT}")));
        }
        Ok(Self {
            path: path.to_owned(),
            entries: contents.plugins,
        })
    }

    /// The text of a lock for the loaded plugins of a catalogue, each library once, in the order of
    /// their names. What is linked into the program needs no lock.
    ///
    /// # Errors
    /// When the hash of a library cannot be calculated.
    pub fn text_of(catalogue: &Catalogue) -> Result<String, LoadError> {
        catalogue.hash_all()?;
        let mut plugins = BTreeSet::new();
        for plugin in catalogue.plugins() {
            if let (Some(file), Some(sha256)) = (&plugin.file, plugin.sha256()?) {
                plugins.insert(Entry {
                    name: plugin.name.clone(),
                    version: plugin.version.clone(),
                    file: name_of(file),
                    sha256: sha256.to_owned(),
                });
            }
        }
        let contents = Contents {
            format: FORMAT,
            plugins: plugins.into_iter().collect(),
        };
        // Numbers and texts are all that a lock has, and TOML can say them.
        let text = toml::to_string(&contents).unwrap_or_default();
        Ok(format!("{HEAD}{text}"))
    }

    /// Writes the lock of a catalogue into a file. An old one stays until the new one is whole.
    ///
    /// # Errors
    /// When the file is there and is no lock, when it cannot be written, or when the hash of a library cannot be
    /// calculated.
    pub fn write(catalogue: &Catalogue, file: &Path) -> Result<(), Error> {
        let is_empty = |file: &Path| fs::metadata(file).is_ok_and(|found| found.len() == 0);
        if file.is_file() && !is_empty(file) && Self::load(file).is_err() {
            let path = file.to_owned();
            return Err(Error::NoLock { path });
        }
        let text = Self::text_of(catalogue)?;
        let mut draft = Draft::begin(file)?;
        let written = draft.write_all(text.as_bytes());
        written.map_err(|error| FileError {
            path: file.to_owned(),
            error,
        })?;
        draft.complete()?;
        Ok(())
    }

    fn admit_one(&self, library: &LibraryFile) -> Result<(), LoadError> {
        let found = library.sha256()?.to_owned();
        if self.entries.iter().any(|entry| entry.sha256 == found) {
            return Ok(());
        }
        let (lock, name) = (self.path.clone(), name_of(library.path()));
        let refusal = match self.entries.iter().find(|entry| entry.file == name) {
            Some(entry) => Refusal::OtherThanLocked {
                lock,
                found,
                locked: entry.sha256.clone(),
            },
            None => Refusal::NotInLock { lock, found },
        };
        Err(LoadError::Refused {
            path: library.path().to_owned(),
            refusal,
        })
    }
}

impl Admission for PluginsLock {
    fn admit(&self, libraries: &[LibraryFile]) -> Result<(), LoadError> {
        // The hashes take the time. An error of one is met again below.
        libraries
            .par_iter()
            .for_each(|library| _ = library.sha256());
        libraries
            .iter()
            .try_for_each(|library| self.admit_one(library))
    }
}

fn read(path: &Path) -> Result<String, PluginsLockError> {
    let unreadable = |source| PluginsLockError::Unreadable {
        path: path.to_owned(),
        source,
    };
    let not_a_file = |what| PluginsLockError::NotAFile {
        path: path.to_owned(),
        what,
    };
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(not_a_file("a folder"));
    }
    if !metadata.is_file() {
        return Err(not_a_file("a pipe or a device"));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(not_a_file("far larger than one"));
    }
    String::from_utf8(bytes).map_err(|_| not_a_file("no text"))
}

fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lock(file: &Path, entries: &[(&str, &str)]) -> PluginsLock {
        let mut text = "format = 1\n".to_owned();
        for (name, sha256) in entries {
            text += &format!(
                "[[plugin]]\nname = \"x\"\nversion = \"1.0.0\"\nfile = \"{name}\"\nsha256 = \"{sha256}\"\n"
            );
        }
        fs::write(file, text).unwrap();
        PluginsLock::load(file).unwrap()
    }

    #[test]
    fn a_library_is_known_by_its_hash_and_blamed_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let library = folder.path().join("liba.so");
        fs::write(&library, "bytes").unwrap();
        let library = LibraryFile::read(&library).unwrap();
        let (file, hash) = (
            folder.path().join("plugins.lock"),
            library.sha256().unwrap(),
        );
        // The same bytes may have another name.
        for entries in [[("liba.so", hash)], [("libb.so", hash)]] {
            lock(&file, &entries).admit_one(&library).unwrap();
        }
        let refusal = |entries: &[(&str, &str)]| match lock(&file, entries).admit_one(&library) {
            Err(LoadError::Refused { refusal, .. }) => refusal,
            other => panic!("{other:?}"),
        };
        assert!(matches!(
            refusal(&[("liba.so", "00")]),
            Refusal::OtherThanLocked { .. }
        ));
        for entries in [&[("libb.so", "00")][..], &[]] {
            assert!(matches!(refusal(entries), Refusal::NotInLock { .. }));
        }
    }

    #[test]
    fn what_is_not_a_lock_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plugins.lock");
        for text in [
            "",
            "format = 2",
            "format = 1\nplugins = []",
            "format = 1\n[[plugin]]\nname = \"x\"",
        ] {
            fs::write(&file, text).unwrap();
            let error = PluginsLock::load(&file).unwrap_err();
            assert!(matches!(error, PluginsLockError::Wrong { .. }), "{text}");
        }
        let of_folder = PluginsLock::load(folder.path()).unwrap_err();
        assert!(matches!(of_folder, PluginsLockError::NotAFile { .. }));
        let of_none = PluginsLock::load(folder.path().join("none")).unwrap_err();
        assert!(matches!(of_none, PluginsLockError::Unreadable { .. }));
    }
}
