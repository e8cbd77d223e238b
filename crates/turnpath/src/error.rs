//! Why something could not be done, and whose fault it is.

use std::path::PathBuf;

use turnpath_core::StrategyError;
use turnpath_files::{FileError, FolderError};
use turnpath_host::{HashError, LoadError};
use turnpath_pipeline::PipelineError;
use turnpath_post::{DryRunError, ReadError};
use turnpath_recipe::{Diagnostic, Diagnostics, RecipeError};

use crate::ablation::PackError;
use crate::data_files::DataFileError;
use crate::drawings::DrawingFileError;
use crate::new_plugin::NewPluginError;
use crate::page::PageError;
use crate::plots::PlotError;
use crate::result_check::ResultError;

/// Where an error comes from: the source behind its messages.
type Source = Box<dyn std::error::Error + Send + Sync>;

/// Why something could not be done. Messages are data, with places in the recipe; whoever shows
/// them gives them their form and their colours.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The recipe could not be read, or something in it is wrong.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The recipe asks for what cannot be done: a strategy that is not there, a tool that does not
    /// fit, a path that a program cannot carry.
    #[error("{diagnostics}")]
    Refused {
        /// What, and where in the recipe.
        diagnostics: Diagnostics,
        /// What the stage said that found it.
        source: Option<Source>,
    },
    /// A strategy failed: its plugin is wrong.
    #[error("{diagnostics}")]
    Strategy {
        /// How, and where the recipe chooses it.
        diagnostics: Diagnostics,
        /// What the stage said that called it.
        source: Option<Source>,
    },
    /// A data file that the recipe names could not be read.
    #[error("{diagnostic}")]
    DataFile {
        /// Why, and where the recipe names it.
        diagnostic: Box<Diagnostic>,
        /// Why.
        source: DataFileError,
    },
    /// A file that the caller names could not be read.
    #[error("cannot read {}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file is there already, and is not to be replaced.
    #[error("{} is there already", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// An output would replace a file that the same command reads.
    #[error("{} is read here, so it is not replaced", path.display())]
    OutputIsInput {
        /// The file, as the output is named.
        path: PathBuf,
    },
    /// A lock of plugins would replace another kind of file.
    #[error("{} is no lock of plugins, so it is not replaced", path.display())]
    NoLock {
        /// The file.
        path: PathBuf,
    },
    /// A plugin could not be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A plugin that the recipe lists could not be loaded.
    #[error("{diagnostic}")]
    ListedPlugin {
        /// Why, and where the recipe lists it.
        diagnostic: Box<Diagnostic>,
        /// Why.
        source: Box<LoadError>,
    },
    /// A new plugin cannot be written as it is asked for.
    #[error(transparent)]
    NewPlugin(#[from] NewPluginError),
    /// The files of an ablation could not be packed.
    #[error(transparent)]
    Pack(#[from] PackError),
    /// A plot cannot be drawn as it is asked for.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A figure for a paper cannot be drawn as it is asked for.
    #[error(transparent)]
    Drawing(#[from] DrawingFileError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The folder of a result takes none.
    #[error(transparent)]
    Folder(FolderError),
    /// A file of a tool path could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file of a tool path has no cut in it.
    #[error("{} has no cutting section to measure", file.display())]
    NothingCut {
        /// The file.
        file: PathBuf,
    },
    /// A program that was read back has other points than the path.
    #[error("{} has {found} points of the path's {expected}", file.display())]
    PointsLost {
        /// The program's file.
        file: PathBuf,
        /// Points in it.
        found: u64,
        /// Points of the path.
        expected: u64,
    },
    /// A dry run does not stay above its part.
    #[error("the dry run {file} is not written")]
    DryRun {
        /// Its file.
        file: String,
        /// Why.
        source: DryRunError,
    },
    /// A dry run was asked for, and no program.
    #[error("a dry run is that of a program, and the recipe asks for none: write [output] posts")]
    NoProgram,
    /// A report could not be put into a file.
    #[error("the report cannot be put into {form}")]
    Report {
        /// The form of the file.
        form: &'static str,
        /// Why.
        source: Source,
    },
    /// The system gives no thread to work on.
    #[error("there is no thread to work on")]
    Threads(#[source] Source),
    /// A folder has no result.
    #[error(transparent)]
    Result(#[from] ResultError),
    /// A result gets no page.
    #[error(transparent)]
    Page(#[from] PageError),
    /// A run of an ablation ended without a result.
    #[error("a run ended unexpectedly")]
    RunLost,
    /// The ablation has no run of this key.
    #[error("the ablation has no run with the key `{key}`")]
    NoRunOfKey {
        /// The key.
        key: String,
    },
    /// A run of the ablation has no key.
    #[error("a run has no key, because of {why}")]
    NoKey {
        /// Its strategies that cannot be told from others of their names.
        why: String,
    },
    /// The observer cancelled the work.
    #[error("the work was cancelled")]
    Cancelled,
}

/// Whose fault an error is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The recipe's, or that of whoever called.
    Request,
    /// A plugin's.
    Plugin,
    /// That of files: one could not be read or written.
    Files,
    /// Nobody's: the work was cancelled.
    Cancelled,
}

impl Error {
    /// Whose fault it is.
    pub fn fault(&self) -> Fault {
        match self {
            Self::Recipe(RecipeError::Wrong(_))
            | Self::Refused { .. }
            | Self::NoProgram
            | Self::Plot(_)
            | Self::Drawing(_)
            | Self::NewPlugin(_)
            | Self::Pack(_)
            | Self::Page(
                PageError::NoRecipe | PageError::OtherRecipe { .. } | PageError::NoPath { .. },
            )
            | Self::Exists { .. }
            | Self::OutputIsInput { .. }
            | Self::NoLock { .. }
            | Self::NoKey { .. }
            | Self::NoRunOfKey { .. } => Fault::Request,
            Self::Strategy { .. } | Self::RunLost => Fault::Plugin,
            Self::Load(error) => fault_of_load(error),
            Self::ListedPlugin { source, .. } => fault_of_load(source),
            Self::Recipe(RecipeError::File { .. })
            | Self::DataFile { .. }
            | Self::Unreadable { .. }
            | Self::File(_)
            | Self::Folder(_)
            | Self::Read(_)
            | Self::NothingCut { .. }
            | Self::PointsLost { .. }
            | Self::DryRun { .. }
            | Self::Result(_)
            | Self::Page(_)
            | Self::Report { .. } => Fault::Files,
            Self::Threads(_) => Fault::Request,
            Self::Cancelled => Fault::Cancelled,
        }
    }

    /// Whether the recipe asks here for what cannot be done, or a strategy gave up on it. Neither a
    /// panic nor a bad answer is a refusal, nor the failure of an inner strategy, whose kind is not
    /// known.
    pub(crate) fn is_refusal(&self) -> bool {
        let gave_up = |source: &Source| {
            let error = source.downcast_ref::<PipelineError>();
            error.is_some_and(|error| {
                matches!(
                    error,
                    PipelineError::Strategy {
                        error: StrategyError::Failed(_) | StrategyError::Parameter { .. },
                        ..
                    }
                )
            })
        };
        match self {
            Self::Refused { .. } => true,
            Self::Strategy { source, .. } => source.as_ref().is_some_and(gave_up),
            _ => false,
        }
    }

    /// The messages that have a place in the recipe; empty where the error's text is all.
    pub fn diagnostics(&self) -> Vec<&Diagnostic> {
        match self {
            Self::Recipe(RecipeError::Wrong(wrong)) => wrong.messages().iter().collect(),
            Self::Refused { diagnostics, .. } | Self::Strategy { diagnostics, .. } => {
                diagnostics.iter().collect()
            }
            Self::ListedPlugin { diagnostic, .. } | Self::DataFile { diagnostic, .. } => {
                vec![diagnostic]
            }
            _ => Vec::new(),
        }
    }

    /// What the user may do about it, where there is no diagnostic that says so.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            Self::Load(error) => error.help(),
            Self::Folder(error) => error.help(),
            Self::NewPlugin(error) => Some(error.help()),
            Self::Pack(error) => Some(error.help()),
            Self::Page(PageError::NoRecipe) => Some("`--recipe FILE` gives it"),
            Self::Page(PageError::NoDataFile { .. }) => {
                Some("`--recipe FILE` names the recipe, beside which its data files lie")
            }
            Self::Page(PageError::NoPath { .. }) => {
                Some("remove the page first to have one without the figures of the path")
            }
            Self::Exists { .. } => Some("`--force` replaces it"),
            Self::OutputIsInput { .. } | Self::NoLock { .. } => {
                Some("give the output another name")
            }
            Self::NoRunOfKey { .. } => Some(
                "`turnpath ablate RECIPE --plan` lists the keys; they change with the recipe, its data \
                 and its plugins",
            ),
            Self::NoKey { .. } => Some(
                "an ablation without a queue makes these runs each time; a queue needs strategies that \
                 take plain values alone",
            ),
            _ => None,
        }
    }

    /// What is wrong, in one line.
    pub fn title(&self) -> String {
        match self.diagnostics().first() {
            Some(first) => first.title().to_owned(),
            None => Diagnostic::from_error(self).title().to_owned(),
        }
    }

    /// What the recipe asks for cannot be done.
    pub(crate) fn refused(diagnostics: impl Into<Diagnostics>) -> Self {
        Self::Refused {
            diagnostics: diagnostics.into(),
            source: None,
        }
    }

    /// The same, with what found it.
    pub(crate) fn refused_by(
        diagnostics: impl Into<Diagnostics>,
        source: impl Into<Source>,
    ) -> Self {
        Self::Refused {
            diagnostics: diagnostics.into(),
            source: Some(source.into()),
        }
    }

    /// A strategy failed.
    pub(crate) fn strategy(diagnostic: Diagnostic, source: impl Into<Source>) -> Self {
        Self::Strategy {
            diagnostics: diagnostic.into(),
            source: Some(source.into()),
        }
    }
}

impl From<FolderError> for Error {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::File(error) => Self::File(error),
            error => Self::Folder(error),
        }
    }
}

impl From<HashError> for Error {
    fn from(error: HashError) -> Self {
        Self::Load(error.into())
    }
}

fn fault_of_load(error: &LoadError) -> Fault {
    match error {
        error if error.is_io() => Fault::Files,
        error if error.is_missing() => Fault::Request,
        _ => Fault::Plugin,
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::refused(diagnostics)
    }
}

#[cfg(test)]
mod tests {
    use turnpath_host::Refusal;

    use super::*;

    #[test]
    fn what_is_missing_what_cannot_be_read_and_what_is_no_plugin_differ() {
        let path = PathBuf::from("labs");
        let missing = LoadError::NoFolder { path: path.clone() };
        let source = std::io::ErrorKind::PermissionDenied.into();
        let unreadable = LoadError::Unreadable { path, source };
        let not_a_plugin = LoadError::Refused {
            path: "libx.so".into(),
            refusal: Refusal::NotAPlugin,
        };
        let faults = [missing, unreadable, not_a_plugin].map(|error| Error::from(error).fault());
        assert_eq!(faults, [Fault::Request, Fault::Files, Fault::Plugin]);
    }

    #[test]
    fn a_strategy_that_gives_up_refuses_and_one_that_breaks_does_not() {
        let diagnostic = || Diagnostic::from_error(&Error::RunLost);
        let strategy = |error| {
            let source = PipelineError::Strategy {
                slot: turnpath_core::Slot::Feed,
                name: "constant".into(),
                plugin: "one".into(),
                context: "for the path".into(),
                error,
            };
            Error::strategy(diagnostic(), source)
        };
        assert!(strategy(StrategyError::failed("too fine")).is_refusal());
        assert!(!strategy(StrategyError::Panicked("at line 3".into())).is_refusal());
        let bad = PipelineError::BadAnswer {
            slot: turnpath_core::Slot::Feed,
            name: "constant".into(),
            plugin: "one".into(),
            what: "not a number".to_owned(),
        };
        assert!(!Error::strategy(diagnostic(), bad).is_refusal());
        assert!(Error::refused(diagnostic()).is_refusal());
        assert!(!Error::Cancelled.is_refusal());
    }

    #[test]
    fn a_title_is_one_line() {
        let first = std::sync::Arc::new(turnpath_host::Plugin {
            name: "one".to_owned(),
            version: "1.0.0".to_owned(),
            file: None,
            hash: None,
            source: None,
            inexact: Vec::new(),
        });
        let error = Error::from(LoadError::TwoOfOneName {
            slot: turnpath_core::Slot::Feed,
            name: "constant".to_owned(),
            second: first.clone(),
            first,
        });
        let title = error.title();
        assert!(
            title.starts_with("two ") && !title.contains('\n'),
            "{title}"
        );
    }
}
