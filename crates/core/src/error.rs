//! What a strategy says when it cannot answer.

use std::borrow::Cow;

use crate::Slot;

/// The answer of a strategy, or why there is none.
pub type Result<T> = std::result::Result<T, StrategyError>;

/// Why a strategy could not answer. The host adds the plugin's and the strategy's name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StrategyError {
    /// The strategy gave up; the text says why, for the person with the recipe open.
    #[error("{0}")]
    Failed(Cow<'static, str>),
    /// A parameter has a value that the strategy cannot work with.
    #[error("parameter `{name}`: {message}")]
    Parameter {
        /// The parameter as it stands in the recipe.
        name: Cow<'static, str>,
        /// What is wrong with it, and what would do.
        message: Cow<'static, str>,
    },
    /// Another strategy that this one asked could not answer: a sampler asks the locus, a
    /// compensator the surface.
    #[error("{message}")]
    Delegate {
        /// The slot of the strategy that was asked.
        slot: Slot,
        /// What it said, with its name and its plugin's.
        message: Cow<'static, str>,
    },
    /// The strategy panicked; the text says with what, and where.
    #[error("panicked: {0}")]
    Panicked(Cow<'static, str>),
}

impl StrategyError {
    /// A failure with a text for the person with the recipe open.
    pub fn failed(message: impl Into<Cow<'static, str>>) -> Self {
        Self::Failed(message.into())
    }

    /// A complaint about one parameter; the host underlines it in the recipe.
    pub fn parameter(
        name: impl Into<Cow<'static, str>>,
        message: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::Parameter {
            name: name.into(),
            message: message.into(),
        }
    }
}
