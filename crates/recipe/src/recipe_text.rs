//! The text of a recipe, from a file or from anything else.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

/// Largest recipe, in bytes: a hundred times as much as a person writes.
const LARGEST: u64 = 1 << 20;

/// Why a file could not be read as a recipe.
#[derive(Debug, thiserror::Error)]
pub enum FileProblem {
    /// The system could not read it.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// It is a folder.
    #[error("it is a folder; give the file in it")]
    Folder,
    /// It is a pipe or a device, which may never give its first byte.
    #[error("it is a pipe or a device; write what it gives into a file first")]
    Special,
    /// It is not UTF-8 text.
    #[error("it is not UTF-8 text (line {line})")]
    NotText {
        /// The first line that is not UTF-8, counted from 1.
        line: usize,
    },
    /// It is far larger than any recipe.
    #[error("it is larger than 1 MiB, the largest that a recipe may be")]
    TooLarge,
}

/// Opens an ordinary file; a pipe may never give its first byte.
pub(crate) fn open_regular(path: &Path) -> Result<File, FileProblem> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_dir() {
        return Err(FileProblem::Folder);
    }
    if !kind.is_file() {
        return Err(FileProblem::Special);
    }
    Ok(File::open(path)?)
}

/// A recipe's text, which is no larger than a recipe may be.
pub(crate) fn read_text(reader: impl Read) -> Result<String, FileProblem> {
    let mut bytes = Vec::new();
    reader.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST {
        return Err(FileProblem::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let lines = error
            .as_bytes()
            .iter()
            .take(good)
            .filter(|byte| **byte == b'\n')
            .count();
        FileProblem::NotText { line: lines + 1 }
    })
}
