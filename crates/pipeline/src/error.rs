//! What can go wrong between a chain and its path.

use turnpath_core::interference::{Conflict, Interference};
use turnpath_core::{Slot, StrategyError};

use crate::path_size::PathSize;

/// The result of a pipeline's step.
pub type Result<T> = std::result::Result<T, PipelineError>;
/// The result of a step that also uses a sink.
pub(crate) type RunResult<T, E> = std::result::Result<T, RunError<E>>;

/// Why there is no path. Names are boxed, which keeps results small.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// A strategy gave up or panicked.
    #[error("the {} `{name}` of {plugin} failed {context}: {error}", slot.noun())]
    Strategy {
        /// Its slot.
        slot: Slot,
        /// Its name.
        name: Box<str>,
        /// Its plugin.
        plugin: Box<str>,
        /// What it was doing, or for which part of the path.
        context: Box<str>,
        /// Its own error.
        #[source]
        error: StrategyError,
    },
    /// A strategy that another strategy called gave up or panicked. The message names the
    /// strategy and its plugin.
    #[error("{message}, {context}")]
    InnerStrategy {
        /// The slot of the strategy that was called.
        slot: Slot,
        /// The number of the surface in a sum, else 0.
        entry: usize,
        /// What the caller was doing, or for which part of the path.
        context: Box<str>,
        /// Its own message.
        message: String,
    },
    /// A strategy gave an answer that cannot be used.
    #[error("the {} `{name}` of {plugin} gave a bad answer: {what}", slot.noun())]
    BadAnswer {
        /// Its slot.
        slot: Slot,
        /// Its name.
        name: Box<str>,
        /// Its plugin.
        plugin: Box<str>,
        /// What is wrong with the answer, and where.
        what: String,
    },
    /// The tool does not fit the part.
    #[error("the tool would gouge")]
    Gouge {
        /// In which ways; at least one.
        conflicts: Vec<Conflict>,
        /// What the part requires of a tool.
        interference: Box<Interference>,
    },
    /// The surface has no height somewhere on the part.
    #[error("{0}")]
    NoSurface(#[source] StrategyError),
    /// No lead-in or no lead-out clears the part.
    #[error("no {which} could be made: {what}")]
    Lead {
        /// `lead-in` or `lead-out`.
        which: &'static str,
        /// Why not.
        what: String,
    },
    /// The surface failed while the path was measured.
    #[error("the path could not be measured: {0}")]
    Measure(#[source] StrategyError),
    /// The path would be too long.
    #[error("the path is too long: {0}")]
    TooLong(PathSize),
    /// The observer cancelled the run.
    #[error("the work was cancelled")]
    Cancelled,
}

/// Why a run did not end with a whole path in its sink.
#[derive(Debug, thiserror::Error)]
pub enum RunError<E> {
    /// There is no path.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The sink could not encode or take a block.
    #[error(transparent)]
    Sink(E),
}
