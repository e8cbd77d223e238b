//! A file that has a temporary name until it is complete.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}", path.display())]
pub struct FileError {
    /// The file or its folder.
    pub path: PathBuf,
    /// Why.
    #[source]
    pub error: io::Error,
}

/// An unfinished file. It is removed when it is dropped, and gets its name when it is complete.
///
/// A link is followed: the file behind the link is replaced, and the link stays.
#[derive(Debug)]
pub struct Draft {
    file: BufWriter<NamedTempFile>,
    /// The path as the caller gave it.
    path: PathBuf,
    /// The path with links followed.
    target: PathBuf,
}

impl Draft {
    /// Checks that nothing under this name prevents writing the file.
    ///
    /// # Errors
    /// When the name belongs to a folder, a device or a link to nothing.
    pub fn can_be(path: &Path) -> Result<(), FileError> {
        target(path).map(|_| ()).map_err(|error| FileError {
            path: path.to_owned(),
            error,
        })
    }

    /// Begins the file `path`. Its folder must exist.
    ///
    /// # Errors
    /// When no file can be created in the folder, or `path` is something else than a file.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let draft = target(&path).and_then(|target| Ok((begin_beside(&target)?, target)));
        match draft {
            Ok((file, target)) => Ok(Self {
                file: BufWriter::with_capacity(BUFFER, file),
                path,
                target,
            }),
            Err(error) => Err(FileError { path, error }),
        }
    }

    /// The path that the complete file will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Everything written so far, as a file that can be read under a temporary name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn readable(&mut self) -> Result<&Path, FileError> {
        match self.flush() {
            Ok(()) => Ok(self.file.get_ref().path()),
            Err(error) => Err(FileError {
                path: self.path.clone(),
                error,
            }),
        }
    }

    /// Gives the complete file its name, and replaces a file that had it before.
    ///
    /// # Errors
    /// When the file cannot be written or renamed.
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

/// The file behind a name. Only a regular file may be replaced: replacing a device or a pipe would
/// remove it.
fn target(path: &Path) -> io::Result<PathBuf> {
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    match fs::metadata(path) {
        Ok(found) if found.is_file() && is_link => fs::canonicalize(path),
        Ok(found) if found.is_file() => Ok(path.to_owned()),
        Ok(found) if found.is_dir() => Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a folder",
        )),
        Ok(_) => Err(io::Error::other("it is not a regular file")),
        Err(error) if error.kind() == io::ErrorKind::NotFound && is_link => Err(io::Error::new(
            error.kind(),
            "it is a link to a file that does not exist",
        )),
        // Any other error occurs again when the draft is created, and is reported then.
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
    // Only the owner may read a temporary file; the permissions of a result follow the umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(without_name)
}

/// The words that tempfile puts between an error and the name of the file.
const BEFORE_NAME: &str = " at path ";

/// The error without the temporary name, which means nothing to the user.
fn without_name(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(BEFORE_NAME) {
        Some((reason, _)) => io::Error::new(error.kind(), reason.to_owned()),
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
        let text = error.to_string();
        assert_eq!(text, "cannot write no/such/folder/result.txt");
        let source = error.error.to_string();
        assert!(!source.contains(".part"), "{source}");
    }

    #[test]
    fn a_folder_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let error = Draft::begin(folder.path()).unwrap_err();
        assert_eq!(error.error.to_string(), "it is a folder");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_replaced_not_even_through_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (pipe, link) = (folder.path().join("pipe"), folder.path().join("link"));
        let mkfifo = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(mkfifo.unwrap().success());
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        for path in [&pipe, &link] {
            let error = Draft::begin(path).unwrap_err();
            assert_eq!(&error.path, path);
            assert_eq!(error.error.to_string(), "it is not a regular file");
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
    fn a_link_to_nothing_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("nothing", &link).unwrap();
        let error = Draft::begin(&link).unwrap_err();
        assert!(
            error.error.to_string().contains("a link to a file"),
            "{error:?}"
        );
    }
}
