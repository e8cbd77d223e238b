//! A file in the making, under another name until it is complete.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// Bytes that are gathered before they are written.
const BUFFER: usize = 1 << 18;

/// A file that could not be made.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {error}", path.display())]
pub struct FileError {
    /// The file, or the folder that it was to lie in.
    pub path: PathBuf,
    /// Why.
    #[source]
    pub error: io::Error,
}

/// A file in the making: removed when it is dropped, named when it is complete.
#[derive(Debug)]
pub struct Draft {
    file: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl Draft {
    /// Begins `path`, whose folder must be there.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let begun = Builder::new()
            .prefix(".turnpath-")
            .suffix(".part")
            .tempfile_in(folder);
        match begun {
            Ok(file) => Ok(Self {
                file: BufWriter::with_capacity(BUFFER, file),
                path,
            }),
            Err(error) => Err(FileError { path, error }),
        }
    }

    /// Where it will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What has been written so far, as a file that can be read under another name.
    pub fn readable(&mut self) -> Result<&Path, FileError> {
        match self.file.flush() {
            Ok(()) => Ok(self.file.get_ref().path()),
            Err(error) => Err(FileError {
                path: self.path.clone(),
                error,
            }),
        }
    }

    /// Everything has been written: the file takes its name, in place of what stood there.
    pub fn complete(self) -> Result<PathBuf, FileError> {
        let Self { file, path } = self;
        let finish = || -> io::Result<()> {
            let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
            readable_by_all(file.as_file())?;
            file.as_file().sync_all()?;
            file.persist(&path)?;
            Ok(())
        };
        match finish() {
            Ok(()) => Ok(path),
            Err(error) => Err(FileError { path, error }),
        }
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Temporary files are their owner's alone; a result is not.
#[cfg(unix)]
fn readable_by_all(file: &File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_: &File) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_has_its_name_only_when_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.txt");
        let mut draft = Draft::begin(&path).unwrap();
        draft.write_all(b"done").unwrap();
        assert!(!path.exists());
        draft.complete().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"done");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_draft_that_is_dropped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        drop(Draft::begin(folder.path().join("result.txt")).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let error = Draft::begin("no/such/folder/result.txt").unwrap_err();
        assert!(
            error.to_string().contains("no/such/folder/result.txt"),
            "{error}"
        );
    }
}
