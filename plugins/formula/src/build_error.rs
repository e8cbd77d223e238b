//! Why a formula cannot be built.

use crate::graph::{MOST_NODES, Refusal};

/// Why a formula cannot be built step by step.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// It has too many steps.
    #[error("the formula has more than {0} steps")]
    TooLarge(usize),
    /// It must keep too many values at once.
    #[error("the formula keeps more than {0} values at once")]
    TooWide(usize),
    /// A part of it has no finite value anywhere.
    #[error("a part of the formula has no finite value")]
    NoFiniteValue,
    /// No function has this name and so many values.
    #[error("formulas have no function `{name}` of {values} values")]
    NoFunction {
        /// The name.
        name: String,
        /// How many values it was given.
        values: usize,
    },
    /// The height jumps where an angle ends.
    #[error("{0}")]
    Jump(String),
}

impl From<Refusal> for BuildError {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::TooLarge => Self::TooLarge(MOST_NODES),
            Refusal::NoFiniteValue => Self::NoFiniteValue,
        }
    }
}
