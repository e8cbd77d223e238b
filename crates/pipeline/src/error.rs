//! What can go wrong between a chain and its path.

use turnpath_core::interference::{Conflict, Interference};
use turnpath_core::{Slot, StrategyError};

/// The result of a pipeline's step.
pub type Result<T> = std::result::Result<T, PipelineError>;

/// Why there is no path.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// A strategy gave up or panicked.
    #[error("the {} `{name}` of {plugin} failed {place}: {error}", slot.noun())]
    Strategy {
        /// Its slot.
        slot: Slot,
        /// Its name.
        name: String,
        /// Its plugin.
        plugin: String,
        /// While doing what.
        place: String,
        /// What it said.
        error: StrategyError,
    },
    /// A strategy that another one asked could not answer; the text names both it and its plugin.
    #[error("{message}, {place}")]
    Asked {
        /// The slot of the strategy that was asked.
        slot: Slot,
        /// While doing what.
        place: String,
        /// What it said.
        message: String,
    },
    /// A strategy answered, but not with what can be used.
    #[error("the {} `{name}` of {plugin} gave a bad answer: {what}", slot.noun())]
    BadAnswer {
        /// Its slot.
        slot: Slot,
        /// Its name.
        name: String,
        /// Its plugin.
        plugin: String,
        /// What is wrong with it, and where.
        what: String,
    },
    /// The tool does not fit the part.
    #[error("the tool would gouge")]
    Gouge {
        /// In which ways; at least one.
        conflicts: Vec<Conflict>,
        /// What the part asks for.
        interference: Box<Interference>,
    },
    /// The surface has no height on a part of the part.
    #[error("{0}")]
    NoSurface(StrategyError),
    /// There is no lead-in or no lead-out that keeps to what it must.
    #[error("no {which} could be made: {what}")]
    Lead {
        /// `lead-in` or `lead-out`.
        which: &'static str,
        /// Why not.
        what: String,
    },
    /// The path's measure could not be taken.
    #[error("the path could not be measured: {0}")]
    Measure(StrategyError),
    /// The path could not be handed on.
    #[error("{0}")]
    Sink(std::io::Error),
}
