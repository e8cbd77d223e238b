//! The errors of reading a tool path.

use std::path::{Path, PathBuf};

/// Why a tool path could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// A line is wrong.
    #[error("{}, line {line}: {what}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: u64,
        /// What is wrong.
        what: String,
    },
}

impl ReadError {
    /// Makes the error of an operation on this file.
    pub(crate) fn of(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |error| Self::File { path, error }
    }

    /// The error with another name of the file, where the file is read under a temporary name.
    pub fn named(mut self, name: &Path) -> Self {
        let (Self::File { path, .. } | Self::Line { path, .. }) = &mut self;
        *path = name.to_owned();
        self
    }
}
