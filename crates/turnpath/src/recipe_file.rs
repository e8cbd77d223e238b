//! The file of a recipe that turnpath writes.

use std::io::Write;
use std::path::Path;

use turnpath_files::{Draft, FileError};

use crate::error::Error;

/// Writes the text of a recipe into a file, which is whole or not there.
///
/// # Errors
/// When the file is there and is not to be replaced, or cannot be written.
pub fn write_recipe(text: &str, path: &Path, replace: bool) -> Result<(), Error> {
    if !replace && path.symlink_metadata().is_ok() {
        let path = path.to_owned();
        return Err(Error::Exists { path });
    }
    let mut draft = Draft::begin(path)?;
    let written = draft.write_all(text.as_bytes());
    written.map_err(|error| FileError {
        path: path.to_owned(),
        error,
    })?;
    draft.complete()?;
    Ok(())
}
