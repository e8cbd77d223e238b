//! A file that has a temporary name until it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::Builder;

use crate::contents::Contents;
use crate::file_error::FileError;
use crate::gate;
use crate::hashed_file::HashedFile;
use crate::operation::{Operation, perform};
use crate::temporary::Temporary;

/// How the name of a draft beside its file begins and ends.
pub(crate) const DRAFT_START: &str = ".turnpath-";
pub(crate) const DRAFT_END: &str = ".part";
/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;

/// An unfinished file. It is removed when it is dropped, and when a signal ends the process.
#[derive(Debug)]
pub struct Draft {
    file: BufWriter<HashedFile>,
    name: WholeName,
}

/// A file that is whole and on the disk, and still without its name. It is removed when it is
/// dropped, and when a signal ends the process.
#[derive(Debug)]
pub struct WholeFile {
    contents: Contents,
    name: WholeName,
}

/// The names of a file.
#[derive(Debug)]
struct WholeName {
    /// The present one.
    temporary: Temporary,
    /// The one to come, as the caller gave it.
    path: PathBuf,
    /// The same with links followed.
    target: PathBuf,
    /// The name in a folder of results, for a file that gets it together with others.
    member: Option<String>,
}

impl Draft {
    /// Checks that nothing under this name prevents writing the file.
    ///
    /// # Errors
    /// When the name belongs to a folder, a device or a link to nothing.
    pub fn can_be(path: &Path) -> Result<(), FileError> {
        target(path).map(|_| ()).map_err(FileError::of(path))
    }

    /// Begins the file `path` beside it. Its folder must exist. A link is followed: the file behind
    /// the link is replaced, and the link stays.
    ///
    /// # Errors
    /// When no file can be created in the folder, or `path` is something else than a file.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let begun = target(&path).and_then(|target| Ok((begin_beside(&target)?, target)));
        match begun {
            Ok(((file, temporary), target)) => Ok(Self::new(
                file,
                WholeName {
                    temporary,
                    path,
                    target,
                    member: None,
                },
            )),
            Err(error) => Err(FileError { path, error }),
        }
    }

    /// Begins the file `path` as the new file `temporary`, on the same file system.
    pub(crate) fn begin_as(
        temporary: PathBuf,
        path: PathBuf,
        member: Option<String>,
    ) -> Result<Self, FileError> {
        let _gate = gate::enter();
        match create(&temporary) {
            Ok(file) => Ok(Self::new(
                file,
                WholeName {
                    temporary: Temporary::new(temporary),
                    target: path.clone(),
                    path,
                    member,
                },
            )),
            Err(error) => Err(FileError { path, error }),
        }
    }

    fn new(file: File, name: WholeName) -> Self {
        let file = HashedFile::new(file, name.temporary.path().to_owned());
        Self {
            file: BufWriter::with_capacity(BUFFER, file),
            name,
        }
    }

    /// From now on another thread reads the file back while it is written. That is for a large file that is
    /// written at once: [`finish`](Self::finish) then has little left to read.
    pub fn read_while_written(&mut self) {
        self.file.get_mut().read_while_written();
    }

    /// The path that the whole file will have.
    pub fn path(&self) -> &Path {
        &self.name.path
    }

    /// The folder in which the draft lies.
    pub fn folder(&self) -> &Path {
        parent(self.name.temporary.path())
    }

    /// Everything written so far, as a file that can be read under a temporary name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn readable(&mut self) -> Result<&Path, FileError> {
        match self.file.flush() {
            Ok(()) => Ok(self.name.temporary.path()),
            Err(error) => Err(FileError::of(&self.name.path)(error)),
        }
    }

    /// Brings all of the file to the disk and reads it back.
    ///
    /// # Errors
    /// When the file cannot be written, or does not read back as it was written.
    pub fn finish(self) -> Result<WholeFile, FileError> {
        let Self { file, name } = self;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error);
        match file.and_then(HashedFile::finish) {
            Ok(contents) => Ok(WholeFile { contents, name }),
            Err(error) => Err(FileError::of(&name.path)(error)),
        }
    }

    /// Gives the whole file its name, and replaces a file that had it before.
    ///
    /// # Errors
    /// When the file cannot be written or renamed.
    pub fn complete(self) -> Result<PathBuf, FileError> {
        self.finish()?.give_name()
    }
}

impl WholeFile {
    /// Its bytes.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// The path that it will have.
    pub fn path(&self) -> &Path {
        &self.name.path
    }

    /// Its name in a folder of results, where it gets it together with others.
    pub fn member(&self) -> Option<&str> {
        self.name.member.as_deref()
    }

    /// Gives the file its name, and replaces a file that had it before.
    ///
    /// # Errors
    /// When the file cannot be renamed.
    pub fn give_name(self) -> Result<PathBuf, FileError> {
        let _gate = gate::enter();
        let name = self.name;
        let from = name.temporary.path();
        let renamed = perform(Operation::Rename, &name.target, || {
            fs::rename(from, &name.target)
        });
        match renamed {
            // The temporary name is free again, whether or not a signal asks for it.
            Ok(()) => {
                let _ = name.temporary.release();
                Ok(name.path)
            }
            Err(error) => Err(FileError {
                path: name.path,
                error,
            }),
        }
    }

    /// Lets the file stay under its temporary name. False if a signal has removed it.
    #[must_use]
    pub(crate) fn release(self) -> bool {
        self.name.temporary.release()
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

/// A new file in the folder of this one.
fn begin_beside(target: &Path) -> io::Result<(File, Temporary)> {
    let mut builder = Builder::new();
    builder.prefix(DRAFT_START).suffix(DRAFT_END);
    let _gate = gate::enter();
    let made = builder.make_in(parent(target), create);
    let (file, path) = made.map_err(without_name)?.into_parts();
    let path = path.keep().map_err(|error| error.error)?;
    Ok((file, Temporary::new(path)))
}

/// Creates a file that must be new; its permissions follow the umask.
fn create(path: &Path) -> io::Result<File> {
    perform(Operation::Create, path, || {
        OpenOptions::new().write(true).create_new(true).open(path)
    })
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
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
        let mut draft = Draft::begin(folder.path().join("result.txt")).unwrap();
        draft.read_while_written();
        draft.write_all(&vec![b'a'; 3 * BUFFER]).unwrap();
        drop(draft);
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
