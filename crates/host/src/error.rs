//! The errors of loading plugins. Each text has one or two lines.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use turnpath_core::Slot;
use turnpath_plugin::loading::{BOUNDARY_VERSION, BoundaryVersion, OpenError, UnknownKind};

use crate::{HashError, Plugin};

/// Most columns of a parameter. Nobody writes rows of a thousand numbers, and messages show an
/// example of a row.
pub(crate) const MOST_COLUMNS: usize = 1000;

/// Why a plugin could not be added to a catalogue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file or folder could not be read.
    #[error("cannot read {}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The private copy of the library could not be written.
    #[error("cannot write a copy of {} to {}", path.display(), folder.display())]
    NoCopy {
        /// The library.
        path: PathBuf,
        /// The folder for temporary files.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file stands where a plugin folder belongs.
    #[error("{} is a file: give the folder in which it lies", path.display())]
    FileForFolder {
        /// The path as the caller gave it.
        path: PathBuf,
    },
    /// A plugin folder does not exist.
    #[error("there is no plugin folder {}", path.display())]
    NoFolder {
        /// The path of the folder as the caller gave it.
        path: PathBuf,
    },
    /// A plugin file does not exist, or is a folder or a device.
    #[error("there is no plugin file {}", path.display())]
    NoFile {
        /// The path of the file as the caller gave it.
        path: PathBuf,
    },
    /// The file exists, but is not a plugin for this program.
    #[error("cannot load the plugin {}", path.display())]
    Refused {
        /// The library.
        path: PathBuf,
        /// Why.
        #[source]
        refusal: Refusal,
    },
    /// Libraries that load one by one end a process that loads all of them.
    #[error(
        "these plugins end the process that loads them together: {}",
        names(paths)
    )]
    NotTogether {
        /// The libraries.
        paths: Vec<PathBuf>,
    },
    /// Two strategies have one name in one slot.
    #[error(
        "two strategies of the slot `{slot}` are named `{name}`: one of {first}, one of {second}"
    )]
    TwoOfOneName {
        /// The slot of both strategies.
        slot: Slot,
        /// The name of both strategies.
        name: String,
        /// The plugin that was added first.
        first: Arc<Plugin>,
        /// The plugin that was added later.
        second: Arc<Plugin>,
    },
    /// A strategy has a name that no recipe could choose.
    #[error(
        "the {} `{}` of {plugin} has a name that no recipe could choose",
        slot.noun(),
        name.escape_debug()
    )]
    UnusableName {
        /// The slot of the strategy.
        slot: Slot,
        /// The strategy's name.
        name: String,
        /// The plugin.
        plugin: Arc<Plugin>,
    },
    /// A strategy declares a parameter with more columns than anyone writes.
    #[error(
        "the {} `{strategy}` of {plugin} declares the parameter `{}` with {columns} columns; at most \
         {MOST_COLUMNS} are allowed",
        slot.noun(),
        param.escape_debug()
    )]
    TooManyColumns {
        /// The slot of the strategy.
        slot: Slot,
        /// The strategy's name.
        strategy: String,
        /// The parameter's name.
        param: String,
        /// The columns that it declares.
        columns: usize,
        /// The plugin.
        plugin: Arc<Plugin>,
    },
    /// A strategy declares a parameter whose name belongs to the host.
    #[error(
        "the {} `{strategy}` of {plugin} declares the parameter `{param}`, a key that belongs to \
         the host",
        slot.noun()
    )]
    HostKey {
        /// The slot of the strategy.
        slot: Slot,
        /// The strategy's name.
        strategy: String,
        /// The parameter's name.
        param: String,
        /// The plugin.
        plugin: Arc<Plugin>,
    },
}

/// Why a file is not a plugin for this program.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// It is not a dynamic library.
    #[error("it is not a dynamic library but {0}")]
    NotALibrary(&'static str),
    /// The file ends before the parts that its headers name.
    #[error("the file is cut short; copy or build it again")]
    Truncated,
    /// Parts of it contradict each other or are missing.
    #[error("the file is damaged ({0}); copy or build it again")]
    Damaged(&'static str),
    /// It is larger than a plugin may be.
    #[error("the file is larger than a plugin may be ({} MiB)", limit >> 20)]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// It is for another processor or operating system.
    #[error(
        "it is built for {found}, but this program is for {ours}; build the plugin for this machine"
    )]
    WrongMachine {
        /// The machine that the library is for.
        found: String,
        /// The machine that this program is for.
        ours: String,
    },
    /// It is a dynamic library, but exports no plugin.
    #[error("it is not a turnpath plugin: the library has no `turnpath_plugin::export!`")]
    NotAPlugin,
    /// It exports several plugins, and its name matches none of them.
    #[error(
        "it holds several plugins ({}); name the file after the one that you want, \
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
        "it is built against turnpath-plugin {found}, but this program has {ours}; \
         rebuild the plugin against turnpath-plugin {}.{}",
        ours.major,
        ours.minor
    )]
    OtherVersion {
        /// The version of the plugin.
        found: BoundaryVersion,
        /// The version of this program.
        ours: BoundaryVersion,
    },
    /// The version fits, but the data have another layout.
    #[error(
        "its version of turnpath-plugin fits this program's {ours}, but its data have another \
         layout; rebuild the plugin against this program's turnpath-plugin"
    )]
    Layout {
        /// The version of this program.
        ours: BoundaryVersion,
        /// The comparison of both layouts, hundreds of lines long.
        details: String,
    },
    /// It declares a parameter of a kind that is newer than this program.
    #[error(
        "its strategy `{}` declares the parameter `{}` as `{}`, a kind that this program does not \
         know; use a newer turnpath",
        .0.strategy.escape_debug(), .0.parameter.escape_debug(), .0.kind.escape_debug()
    )]
    UnknownKind(
        /// The parameter.
        UnknownKind,
    ),
    /// Its SHA-256 is not the one that the lock has for it.
    #[error("its SHA-256 is {}, but {} has {}", short(found), lock.display(), short(locked))]
    OtherThanLocked {
        /// The lock.
        lock: PathBuf,
        /// SHA-256 of the file.
        found: String,
        /// SHA-256 in the lock.
        locked: String,
    },
    /// The lock does not have it.
    #[error("it is not in {} (its SHA-256 is {})", lock.display(), short(found))]
    NotInLock {
        /// The lock.
        lock: PathBuf,
        /// SHA-256 of the file.
        found: String,
    },
    /// A process that loads it ends, or does not come back.
    #[error("{how}; if the file may be damaged, copy or build it again")]
    FailedTrial {
        /// What happens: "loading it ends the process (SIGSEGV)".
        how: String,
    },
    /// The system's loader refused it.
    #[error("the system's loader refuses it: {reason}")]
    Loader {
        /// The loader's message.
        reason: String,
        /// What the user may try.
        hint: Option<&'static str>,
    },
}

/// The beginning of a hash, enough to tell two apart.
fn short(sha256: &str) -> String {
    let beginning: String = sha256.chars().take(12).collect();
    format!("{beginning}…")
}

fn names(paths: &[PathBuf]) -> String {
    let names: Vec<String> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    names.join(", ")
}

impl From<HashError> for LoadError {
    fn from(HashError { path, source }: HashError) -> Self {
        Self::Unreadable { path, source }
    }
}

impl From<OpenError> for Refusal {
    fn from(error: OpenError) -> Self {
        let ours = BOUNDARY_VERSION;
        match error {
            OpenError::NotAPlugin => Self::NotAPlugin,
            OpenError::Damaged => Self::Damaged("its description of itself cannot be read"),
            OpenError::Version(found) => Self::OtherVersion { found, ours },
            OpenError::Layout(details) => Self::Layout { ours, details },
            OpenError::UnknownKind(unknown) => Self::UnknownKind(unknown),
        }
    }
}

impl LoadError {
    /// Whether a file could not be read or written. An error that is neither of this kind nor
    /// [missing](Self::is_missing) is the plugin's fault.
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. } | Self::NoCopy { .. })
    }

    /// Whether a file or folder does not exist: then the call or the recipe is wrong.
    pub fn is_missing(&self) -> bool {
        matches!(
            self,
            Self::NoFolder { .. } | Self::FileForFolder { .. } | Self::NoFile { .. }
        )
    }

    /// The file or folder of the error; for two strategies of one name the file that was added later.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Unreadable { path, .. }
            | Self::NoCopy { path, .. }
            | Self::NoFolder { path }
            | Self::FileForFolder { path }
            | Self::NoFile { path }
            | Self::Refused { path, .. } => Some(path),
            Self::NotTogether { paths } => paths.first().map(PathBuf::as_path),
            Self::TwoOfOneName { second: plugin, .. }
            | Self::UnusableName { plugin, .. }
            | Self::TooManyColumns { plugin, .. }
            | Self::HostKey { plugin, .. } => plugin.file.as_deref(),
        }
    }

    /// What the user may do about it, where the message itself does not say.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            Self::TwoOfOneName { .. } => Some("leave one of the two out, or rename it"),
            Self::NotTogether { .. } => Some("leave one of them out"),
            Self::Refused {
                refusal: Refusal::OtherThanLocked { .. } | Refusal::NotInLock { .. },
                ..
            } => Some(
                "if you trust the file, write the lock anew with `turnpath list --lock`; if you do \
                 not, find out who changed it",
            ),
            Self::UnusableName { .. } => Some(
                "name it in lower-case letters, digits and hyphens, and build the plugin again",
            ),
            Self::HostKey { .. } => Some(
                "rename the parameter and build the plugin again; `use`, `speed`, `scale`, \
                 `decentre_x`, `decentre_y`, `clocking` and `piston` belong to the host",
            ),
            Self::Refused {
                refusal: Refusal::Loader { hint, .. },
                ..
            } => *hint,
            _ => None,
        }
    }

    /// The long comparison of a [`Refusal::Layout`].
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
    use std::error::Error;

    use turnpath_core::HOST_KEYS;

    use super::*;

    fn refused(refusal: impl Into<Refusal>) -> LoadError {
        LoadError::Refused {
            path: "libx.so".into(),
            refusal: refusal.into(),
        }
    }

    #[test]
    fn the_message_of_another_layout_has_one_line_and_the_details_are_separate() {
        let error = refused(OpenError::Layout("line\n".repeat(500)));
        assert_eq!(error.to_string(), "cannot load the plugin libx.so");
        assert_eq!(
            error.source().map(ToString::to_string),
            Some(format!(
                "its version of turnpath-plugin fits this program's {BOUNDARY_VERSION}, but its data \
                 have another layout; rebuild the plugin against this program's turnpath-plugin"
            ))
        );
        assert_eq!(error.layout_details().map(str::len), Some(2500));
        assert_eq!(refused(Refusal::NotAPlugin).layout_details(), None);
    }

    #[test]
    fn an_unknown_kind_is_refused_with_the_names_of_strategy_and_parameter() {
        let refusal = Refusal::from(OpenError::UnknownKind(UnknownKind {
            strategy: "balanced".into(),
            parameter: "counterweight".into(),
            kind: "mass".into(),
        }));
        assert_eq!(
            refusal.to_string(),
            "its strategy `balanced` declares the parameter `counterweight` as `mass`, a kind that \
             this program does not know; use a newer turnpath"
        );
    }

    #[test]
    fn the_help_names_every_key_of_the_host() {
        let error = LoadError::HostKey {
            slot: Slot::Feed,
            strategy: String::new(),
            param: String::new(),
            plugin: Arc::new(Plugin {
                name: String::new(),
                version: String::new(),
                file: None,
                hash: None,
                source: None,
                inexact: Vec::new(),
            }),
        };
        let help = error.help().unwrap_or_default();
        for key in HOST_KEYS {
            assert!(help.contains(&format!("`{key}`")), "{key}");
        }
    }

    #[test]
    fn a_hint_is_help_and_no_part_of_the_message() {
        let error = |hint| {
            let reason = "no".to_owned();
            LoadError::Refused {
                path: "libx.so".into(),
                refusal: Refusal::Loader { reason, hint },
            }
        };
        assert_eq!(error(None).help(), None);
        assert_eq!(error(Some("set TMPDIR")).help(), Some("set TMPDIR"));
    }
}
