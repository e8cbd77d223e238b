//! Errors of a folder that is packed.

use std::path::PathBuf;

/// Why the files of an ablation cannot be packed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PackError {
    /// The folder is there, and something is in it.
    #[error("{} is not empty", folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// The recipe is not as its file has it.
    #[error("the call changes the recipe, and its file would travel without the change")]
    Changed,
    /// Two files have one place in the folder.
    #[error("two files would be {} in the folder", place.display())]
    Twice {
        /// The place.
        place: PathBuf,
    },
    /// A plugin's file has changed since it was loaded.
    #[error("the plugin {} has changed since it was loaded", path.display())]
    PluginChanged {
        /// The library.
        path: PathBuf,
    },
}

impl PackError {
    /// What the user may do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotEmpty { .. } => "give a folder that is not there yet",
            Self::Changed => "write the change into the recipe's file",
            Self::Twice { .. } => "give one of them another name",
            Self::PluginChanged { .. } => "call again: the new plugin is loaded then",
        }
    }
}
