//! The writer's own files and folders: never links, since what lies behind one is somebody else's.

use std::fs::{self, Metadata};
use std::io;
use std::path::Path;

use super::error::FolderError;
use crate::file_error::FileError;

/// Whether the folder is there.
///
/// # Errors
/// When something else has its name, a link among it, or when it cannot be asked about.
pub fn folder_is_there(path: &Path) -> Result<bool, FolderError> {
    is_there(path, Metadata::is_dir)
}

/// Whether the file is there.
///
/// # Errors
/// When something else has its name, a link among it, or when it cannot be asked about.
pub fn file_is_there(path: &Path) -> Result<bool, FolderError> {
    is_there(path, Metadata::is_file)
}

/// Whether a rename may lead from one folder to the other. False where nobody can say.
#[cfg(unix)]
pub fn same_file_system(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| fs::metadata(path).map(|found| found.dev()).ok();
    device(one).is_some() && device(one) == device(other)
}

/// Whether a rename may lead from one folder to the other. False where nobody can say.
#[cfg(not(unix))]
pub fn same_file_system(_: &Path, _: &Path) -> bool {
    false
}

fn is_there(path: &Path, is_kind: impl Fn(&Metadata) -> bool) -> Result<bool, FolderError> {
    match fs::symlink_metadata(path) {
        Ok(found) if is_kind(&found) => Ok(true),
        Ok(_) => Err(FolderError::Foreign {
            path: path.to_owned(),
        }),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(FileError::of(path)(error).into()),
    }
}
