//! The errors of strategies.

use std::borrow::Cow;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::Slot;

/// The answer of a strategy, or the reason why there is none.
pub type Result<T> = std::result::Result<T, StrategyError>;

/// Why a strategy could not answer. The host adds the names of the plugin and of the strategy.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StrategyError {
    /// The strategy gave up. The text explains the reason to the person who has the recipe open.
    #[error("{0}")]
    Failed(Cow<'static, str>),
    /// A parameter has a value that the strategy cannot work with.
    #[error("parameter `{name}`: {message}")]
    Parameter {
        /// The parameter's key in the recipe.
        name: Cow<'static, str>,
        /// What is wrong with the value, and which value would do.
        message: Cow<'static, str>,
        /// The bytes of a text that are wrong; none for the value as a whole. Plugins that were
        /// built before do not give it. A box, so that the errors without it stay small.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        place: Option<Box<Range<usize>>>,
    },
    /// A strategy that this one called could not answer. A sampler calls the locus, for example,
    /// and a compensator calls the surface.
    #[error("{message}")]
    Delegate {
        /// The slot of the strategy that was called.
        slot: Slot,
        /// Which of the slot's strategies it is: the number of a surface in a sum, else 0. A plugin
        /// that was built before sums hands the error on without it.
        #[serde(default)]
        entry: usize,
        /// That strategy's error, with its name and the name of its plugin.
        message: Cow<'static, str>,
    },
    /// The strategy panicked. The text gives the panic's message and its source location.
    #[error("panicked: {0}")]
    Panicked(Cow<'static, str>),
}

impl StrategyError {
    /// A failure, with a text for the person who has the recipe open.
    pub fn failed(message: impl Into<Cow<'static, str>>) -> Self {
        Self::Failed(message.into())
    }

    /// An error in one parameter. The host underlines the parameter in the recipe.
    pub fn parameter(
        name: impl Into<Cow<'static, str>>,
        message: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::Parameter {
            name: name.into(),
            message: message.into(),
            place: None,
        }
    }
}
