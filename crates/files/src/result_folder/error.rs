//! Why a folder takes no result.

use std::io;
use std::path::PathBuf;

use crate::file_error::FileError;

/// Why a folder takes no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// Another process writes into the folder, or another part of this one.
    #[error("another run is writing into {}", folder.display())]
    OtherWriter {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder cannot be claimed.
    #[error("cannot claim {}", folder.display())]
    Claim {
        /// The folder.
        folder: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// Something else has the name of a file or folder of the writer's own.
    #[error("cannot use {}: it is a link, or something else that turnpath did not make", path.display())]
    Foreign {
        /// What has the name.
        path: PathBuf,
    },
    /// The plan of a whole result is damaged.
    #[error("the plan of an unfinished result is damaged")]
    Plan {
        /// What is wrong with it.
        #[source]
        source: FileError,
    },
    /// The name of a file of the result belongs to a link.
    #[error("cannot write {}: it is a link, and a result has its files in its own folder", path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A whole result did not get all its names.
    #[error("the result is whole, but {} did not get all its files", folder.display())]
    Unfinished {
        /// The folder.
        folder: PathBuf,
        /// What stopped it.
        #[source]
        source: FileError,
    },
}

impl FolderError {
    /// What the user may do about it.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            Self::File(_) => None,
            Self::OtherWriter { .. } => {
                Some("wait until it ends, or choose another folder with `-o`")
            }
            Self::Claim { .. } => {
                Some("results need a file system that locks files: choose another folder with `-o`")
            }
            Self::Link { .. } => {
                Some("remove the link, or give the folder that it leads into with `-o`")
            }
            Self::Foreign { .. } => {
                Some("remove it or give it another name, or choose another folder with `-o`")
            }
            Self::Plan { .. } => Some(
                "remove the folder `.turnpath/commit` in the folder of the result, and run again",
            ),
            Self::Unfinished { .. } => Some(
                "see to this cause: close the file if a program has it open, or remove what has its \
                 name; the next call with this folder gives the files their names",
            ),
        }
    }
}
