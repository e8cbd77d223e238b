//! The files of a whole result get their names: what is left to do after the commit point, and what
//! the next writer does if it was not done.

use std::fs;
use std::io;
use std::path::Path;

use super::listing::Plan;
use crate::file_error::FileError;
use crate::operation::{Operation, perform};

/// The folder of a whole result whose files do not have their names yet.
pub const COMMIT: &str = "commit";
/// The plan in it. No file of a result has this name, since no index does.
pub const PLAN: &str = ".turnpath.plan";

/// Gives the files of a whole result their names, if `hidden` has one. May be called again after it
/// failed, or after the process ended at any place of it.
pub fn complete(folder: &Path, hidden: &Path) -> Result<(), FileError> {
    let commit = hidden.join(COMMIT);
    if !is_there(&commit)? {
        return Ok(());
    }
    let plan_file = commit.join(PLAN);
    match Plan::read(&plan_file) {
        Ok(plan) => {
            give_names(folder, &commit, &plan)?;
            remove_file(&plan_file)?;
        }
        // The plan goes last.
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(FileError::of(&plan_file)(error)),
    }
    let removed = perform(Operation::RemoveFolder, &commit, || fs::remove_dir(&commit));
    removed.map_err(FileError::of(&commit))
}

fn give_names(folder: &Path, commit: &Path, plan: &Plan) -> Result<(), FileError> {
    let (new_index, index) = (commit.join(&plan.index), folder.join(&plan.index));
    if !is_there(&new_index)? {
        // All was done but to remove what is left of the commit.
        return Ok(());
    }
    remove_file(&index)?;
    for file in &plan.files {
        let from = commit.join(file);
        if is_there(&from)? {
            rename(&from, &folder.join(file))?;
        }
    }
    for old in &plan.remove {
        let path = folder.join(&old.file);
        // Bytes that the old result did not have are not its own, nor are those that nobody may read.
        let is_own = match old.is_in(folder) {
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied => false,
            asked => asked.map_err(FileError::of(&path))?,
        };
        if is_own {
            remove_file(&path)?;
        }
    }
    rename(&new_index, &index)?;
    sync_folder(folder)
}

fn is_there(path: &Path) -> Result<bool, FileError> {
    path.try_exists().map_err(FileError::of(path))
}

fn rename(from: &Path, to: &Path) -> Result<(), FileError> {
    perform(Operation::Rename, to, || fs::rename(from, to)).map_err(FileError::of(to))
}

/// Removes a file, if it is there.
fn remove_file(path: &Path) -> Result<(), FileError> {
    match perform(Operation::RemoveFile, path, || fs::remove_file(path)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(FileError::of(path)(error)),
        _ => Ok(()),
    }
}

/// Brings the names in a folder to the disk. Some file systems cannot, and say that the call is not
/// valid.
pub fn sync_folder(folder: &Path) -> Result<(), FileError> {
    match perform(Operation::Sync, folder, || sync(folder)) {
        Err(error) if error.kind() != io::ErrorKind::InvalidInput => {
            Err(FileError::of(folder)(error))
        }
        _ => Ok(()),
    }
}

#[cfg(unix)]
fn sync(folder: &Path) -> io::Result<()> {
    fs::File::open(folder)?.sync_all()
}

/// Elsewhere a folder cannot be opened as a file.
#[cfg(not(unix))]
fn sync(_: &Path) -> io::Result<()> {
    Ok(())
}
