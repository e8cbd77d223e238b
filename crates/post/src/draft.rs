//! A file in the making, under another name until it is complete.

use std::fs;
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
///
/// A link is followed: the file that it points to is replaced, and the link stays.
#[derive(Debug)]
pub struct Draft {
    file: BufWriter<NamedTempFile>,
    /// As it was asked for.
    path: PathBuf,
    /// The same with links followed.
    target: PathBuf,
}

impl Draft {
    /// Whether a file of this name can be made or replaced, as far as its name tells.
    ///
    /// # Errors
    /// When something else stands there: a folder, a device, a link that leads nowhere.
    pub fn can_be(path: &Path) -> Result<(), FileError> {
        target(path).map(|_| ()).map_err(|error| FileError {
            path: path.to_owned(),
            error,
        })
    }

    /// Begins `path`, whose folder must be there.
    ///
    /// # Errors
    /// When the folder takes no file, or something else than a file stands at `path`.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let begun = target(&path).and_then(|target| Ok((begin_beside(&target)?, target)));
        match begun {
            Ok((file, target)) => Ok(Self {
                file: BufWriter::with_capacity(BUFFER, file),
                path,
                target,
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
        match self.flush() {
            Ok(()) => Ok(self.file.get_ref().path()),
            Err(error) => Err(FileError {
                path: self.path.clone(),
                error,
            }),
        }
    }

    /// Everything has been written: the file takes its name, in place of what stood there.
    pub fn complete(self) -> Result<PathBuf, FileError> {
        let Self { file, path, target } = self;
        let finish = || -> io::Result<()> {
            let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
            file.as_file().sync_all()?;
            file.persist(&target)?;
            Ok(())
        };
        match finish().map_err(without_name) {
            Ok(()) => Ok(path),
            Err(error) => Err(FileError { path, error }),
        }
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes).map_err(without_name)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush().map_err(without_name)
    }
}

/// The file that a name stands for. Only a file is replaced: a device or a pipe would be gone.
fn target(path: &Path) -> io::Result<PathBuf> {
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    match fs::metadata(path) {
        Ok(found) if found.is_file() && is_link => fs::canonicalize(path),
        Ok(found) if found.is_file() => Ok(path.to_owned()),
        Ok(found) if found.is_dir() => Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a folder",
        )),
        Ok(_) => Err(io::Error::other("it is no regular file")),
        Err(error) if error.kind() == io::ErrorKind::NotFound && is_link => Err(io::Error::new(
            error.kind(),
            "it is a link to a file that is not there",
        )),
        // Whatever else stops the way there stops the beginning too, which tells it.
        Err(_) => Ok(path.to_owned()),
    }
}

fn begin_beside(target: &Path) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = Builder::new();
    builder.prefix(".turnpath-").suffix(".part");
    // Temporary files are their owner's alone; a result is whoever's the user's umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(without_name)
}

/// What tempfile puts between an error and the name of its file.
const BEFORE_NAME: &str = " at path ";

/// The error without the draft's own name, which tells nobody anything.
fn without_name(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(BEFORE_NAME) {
        Some((said, _)) => io::Error::new(error.kind(), said.to_owned()),
        None => error,
    }
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
        assert_eq!(fs::read(&path).unwrap(), b"done");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_draft_that_is_dropped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        drop(Draft::begin(folder.path().join("result.txt")).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let error = Draft::begin("no/such/folder/result.txt").unwrap_err();
        let said = error.to_string();
        assert!(said.contains("no/such/folder/result.txt"), "{said}");
        assert!(!said.contains(".part"), "{said}");
    }

    #[test]
    fn a_folder_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let error = Draft::begin(folder.path()).unwrap_err();
        assert!(error.to_string().ends_with("it is a folder"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_replaced_nor_through_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (pipe, link) = (folder.path().join("pipe"), folder.path().join("link"));
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        for path in [&pipe, &link] {
            let error = Draft::begin(path).unwrap_err();
            assert_eq!(&error.path, path);
            assert!(
                error.to_string().ends_with("it is no regular file"),
                "{error}"
            );
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let elsewhere = tempfile::tempdir().unwrap();
        let (file, link) = (elsewhere.path().join("file"), folder.path().join("link"));
        fs::write(&file, "before").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let mut draft = Draft::begin(&link).unwrap();
        draft.write_all(b"after").unwrap();
        assert_eq!(draft.complete().unwrap(), link);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"after");
        assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_nowhere_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("nothing", &link).unwrap();
        let error = Draft::begin(&link).unwrap_err();
        assert!(error.to_string().contains("a link to a file"), "{error}");
    }
}
