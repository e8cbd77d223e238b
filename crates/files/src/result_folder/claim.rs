//! One writer in a folder at a time.

use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::error::FolderError;
use super::made_folders::MadeFolders;
use super::own;
use crate::file_error::FileError;
use crate::gate;
use crate::operation::{Operation, perform};
use crate::registry::Registration;

/// The file that the system locks for the writer.
const CLAIM: &str = ".turnpath.lock";
/// How often the claim is tried while other writers make and remove the file and the folder. Each
/// try that fails means that another writer has just ended.
const TRIES: usize = 1000;

/// The claim of a writer on a folder, held until this is dropped: a lock of the system on a file, so
/// that it ends with the process. On Unix the file goes with the claim; elsewhere it stays, since a file that is open cannot be told from one of the same name.
#[derive(Debug)]
pub struct FolderClaim {
    path: PathBuf,
    registration: Option<Registration>,
    /// Closing the file ends the claim.
    _file: File,
}

impl FolderClaim {
    /// Claims the folder at once or not at all; makes the folder if it is not there.
    pub fn take(folder: &Path, made: &mut MadeFolders) -> Result<Self, FolderError> {
        let path = folder.join(CLAIM);
        let failed = |error| FolderError::Claim {
            folder: folder.to_owned(),
            error,
        };
        for _ in 0..TRIES {
            made.make(folder).map_err(FileError::of(folder))?;
            own::file_is_there(&path)?;
            let file = match open(&path) {
                // A writer that failed has removed the folder that it had made.
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                file => file.map_err(FileError::of(&path))?,
            };
            match perform(Operation::Claim, &path, || try_lock(&file)) {
                Ok(true) if is_file(&file, &path).map_err(failed)? => {
                    let registration = registered(&path);
                    return Ok(Self {
                        path,
                        registration,
                        _file: file,
                    });
                }
                // The file was removed by the writer that had the claim.
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => return Err(failed(error)),
            }
        }
        Err(FolderError::OtherWriter {
            folder: folder.to_owned(),
        })
    }
}

fn open(path: &Path) -> io::Result<File> {
    perform(Operation::Create, path, || {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        follow_no_link(&mut options);
        options.open(path)
    })
}

/// A link that came after the check is not followed.
#[cfg(unix)]
fn follow_no_link(options: &mut OpenOptions) {
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags(rustix::fs::OFlags::NOFOLLOW.bits() as i32);
}

#[cfg(not(unix))]
fn follow_no_link(_: &mut OpenOptions) {}

/// False if another has the claim.
fn try_lock(file: &File) -> io::Result<bool> {
    match file.try_lock() {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Whether this open file is the one of this name. Only who has the claim removes the file, so it
/// stays the one of this name from then on.
#[cfg(unix)]
fn is_file(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: std::fs::Metadata| (found.dev(), found.ino());
    match std::fs::symlink_metadata(path) {
        Ok(named) => Ok(identity(named) == identity(file.metadata()?)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

#[cfg(not(unix))]
fn is_file(_: &File, _: &Path) -> io::Result<bool> {
    Ok(true)
}

#[cfg(unix)]
fn registered(path: &Path) -> Option<Registration> {
    use crate::registry::DraftKind;
    Some(Registration::new(DraftKind::Claim, path))
}

#[cfg(not(unix))]
fn registered(_: &Path) -> Option<Registration> {
    None
}

impl Drop for FolderClaim {
    /// The file goes while the claim is held. Its registration ends first, since another writer may
    /// have a file of this name as soon as this one is gone; a signal waits meanwhile.
    fn drop(&mut self) {
        let _gate = gate::enter_if_free();
        if self.registration.take().is_some_and(Registration::withdraw) {
            let _ = perform(Operation::RemoveFile, &self.path, || {
                std::fs::remove_file(&self.path)
            });
        }
    }
}
