//! Why there is no new plugin.

use std::path::PathBuf;

use super::name::NameError;
use super::source::SourceError;

/// Why there is no new plugin.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NewPluginError {
    /// The name cannot be used.
    #[error(transparent)]
    Name(#[from] NameError),
    /// The crates are not there.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The crate's folder is there already.
    #[error("{} is there already", folder.display())]
    FolderExists {
        /// The folder.
        folder: PathBuf,
    },
}

impl NewPluginError {
    /// What would do.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::Name(error) => error.help(),
            Self::Source(_) => {
                "give with `--crates` the folder of turnpath's repository, the address of a git repository such as \
                 https://host/turnpath.git, or `registry`"
            }
            Self::FolderExists { .. } => "choose another name, or another folder with `--dir`",
        }
    }
}
