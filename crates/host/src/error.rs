//! Why plugins could not be loaded, in one or two lines each.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use turnpath_core::Slot;
use turnpath_plugin::loading::{BOUNDARY_VERSION, BoundaryVersion, OpenError};

use crate::Plugin;

/// Why a catalogue could not take a plugin.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file or folder could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// No private copy of the library could be written.
    #[error("cannot write a copy of {} to {}: {source}", path.display(), folder.display())]
    NoCopy {
        /// The library.
        path: PathBuf,
        /// The folder for temporary files.
        folder: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A plugin folder does not exist, or is a file.
    #[error("there is no plugin folder {}", path.display())]
    NoFolder {
        /// The folder that was asked for.
        path: PathBuf,
    },
    /// A plugin file does not exist, or is a folder or a device.
    #[error("there is no plugin file {}", path.display())]
    NoFile {
        /// The file that was asked for.
        path: PathBuf,
    },
    /// The file is there, and is not a plugin for this program.
    #[error("{}: {refusal}", path.display())]
    Refused {
        /// The library.
        path: PathBuf,
        /// What is wrong with it.
        refusal: Refusal,
    },
    /// Two strategies have one name in one slot.
    #[error(
        "two {}s are named `{name}`: one of {first}, one of {second}\n\
         leave one of the two plugins out, or rename its strategy",
        slot.noun()
    )]
    TwoOfOneName {
        /// The slot of both.
        slot: Slot,
        /// The name of both.
        name: String,
        /// The plugin that was there first.
        first: Arc<Plugin>,
        /// The plugin that came later.
        second: Arc<Plugin>,
    },
}

/// What is wrong with a file that should be a plugin.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// It is no dynamic library at all.
    #[error("not a dynamic library, but {0}")]
    NotALibrary(&'static str),
    /// Its headers speak of more than there is.
    #[error("the file is cut short; copy or build it again")]
    Truncated,
    /// Its headers contradict each other.
    #[error("the file is damaged ({0}); copy or build it again")]
    Damaged(&'static str),
    /// It is larger than any plugin.
    #[error("the file is larger than a plugin may be ({} MiB)", limit >> 20)]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// It is for another processor or operating system.
    #[error("built for {found}, but this program is for {ours}; build the plugin for this machine")]
    WrongMachine {
        /// What it is for.
        found: String,
        /// What this program is for.
        ours: String,
    },
    /// It is a dynamic library, but exports no plugin.
    #[error("not a turnpath plugin: a library without `turnpath_plugin::export!`")]
    NotAPlugin,
    /// It exports several plugins, and its name is that of none.
    #[error(
        "holds several plugins ({}); name the file after the one that is meant, \
         {DLL_PREFIX}{}{DLL_SUFFIX}",
        .0.join(", "),
        .0.first().map_or("plugin", String::as_str)
    )]
    SeveralPlugins(
        /// The crates' names.
        Vec<String>,
    ),
    /// It was built against another version of the boundary.
    #[error(
        "built against turnpath-plugin {found}, but this program has {ours}; \
         rebuild the plugin against turnpath-plugin {}.{}",
        ours.major,
        ours.minor
    )]
    OtherVersion {
        /// The plugin's.
        found: BoundaryVersion,
        /// This program's.
        ours: BoundaryVersion,
    },
    /// The version is right, but the data are laid out differently.
    #[error(
        "says turnpath-plugin {ours} like this program, but its data are laid out differently; \
         rebuild the plugin against this program's turnpath-plugin"
    )]
    Layout {
        /// The version of both.
        ours: BoundaryVersion,
        /// The comparison, hundreds of lines long.
        details: String,
    },
    /// The system's loader refused it.
    #[error("the system cannot load it: {reason}{}", hint.map(|hint| format!("\n{hint}")).unwrap_or_default())]
    Loader {
        /// What the loader says.
        reason: String,
        /// What may be done about it.
        hint: Option<&'static str>,
    },
}

impl From<OpenError> for Refusal {
    fn from(error: OpenError) -> Self {
        let ours = BOUNDARY_VERSION;
        match error {
            OpenError::NotAPlugin => Self::NotAPlugin,
            OpenError::Version(found) => Self::OtherVersion { found, ours },
            OpenError::Layout(details) => Self::Layout { ours, details },
        }
    }
}

impl LoadError {
    /// Whether a file could not be read or written. What is neither this nor
    /// [missing](Self::is_missing) is a plugin's fault.
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. } | Self::NoCopy { .. })
    }

    /// Whether what was asked for is not there: then the call, or the recipe, is wrong.
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::NoFolder { .. } | Self::NoFile { .. })
    }

    /// The file or folder that was asked for; for two of one name the file that came later.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Unreadable { path, .. }
            | Self::NoCopy { path, .. }
            | Self::NoFolder { path }
            | Self::NoFile { path }
            | Self::Refused { path, .. } => Some(path),
            Self::TwoOfOneName { second, .. } => second.file.as_deref(),
        }
    }

    /// The long comparison behind a [`Refusal::Layout`].
    pub fn layout_details(&self) -> Option<&str> {
        match self {
            Self::Refused {
                refusal: Refusal::Layout { details, .. },
                ..
            } => Some(details),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(refusal: impl Into<Refusal>) -> LoadError {
        LoadError::Refused {
            path: "libx.so".into(),
            refusal: refusal.into(),
        }
    }

    #[test]
    fn another_layout_is_one_line_and_its_details_are_apart() {
        let error = refused(OpenError::Layout("line\n".repeat(500)));
        assert_eq!(
            error.to_string(),
            format!(
                "libx.so: says turnpath-plugin {BOUNDARY_VERSION} like this program, but its data \
                 are laid out differently; rebuild the plugin against this program's \
                 turnpath-plugin"
            )
        );
        assert_eq!(error.layout_details().map(str::len), Some(2500));
        assert_eq!(refused(Refusal::NotAPlugin).layout_details(), None);
    }

    #[test]
    fn a_hint_stands_on_a_line_of_its_own() {
        let loader = |hint| {
            let reason = "no".to_owned();
            refused(Refusal::Loader { reason, hint }).to_string()
        };
        assert_eq!(loader(None), "libx.so: the system cannot load it: no");
        let both = "libx.so: the system cannot load it: no\nset TMPDIR";
        assert_eq!(loader(Some("set TMPDIR")), both);
    }
}
