//! What is wrong with a formula, and where.

use std::ops::Range;

use crate::dimension::Dimension;

/// A mistake in a formula's text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{mistake}")]
pub struct Complaint {
    /// The bytes of the text that are wrong.
    pub place: Range<usize>,
    /// What is wrong with them.
    pub mistake: Mistake,
}

/// What can be wrong with a formula.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Mistake {
    /// There is no formula.
    #[error("there is no formula")]
    Empty,
    /// The text has more bytes than a formula may have.
    #[error("a formula has at most {0} bytes")]
    TooLong(usize),
    /// Parentheses, powers and signs stand too deep in each other.
    #[error("the formula is nested more than {0} deep")]
    TooDeep(usize),
    /// The formula has too many steps.
    #[error("the formula has more than {0} steps")]
    TooLarge(usize),
    /// The formula must keep too many values at once.
    #[error("the formula keeps more than {0} values at once")]
    TooWide(usize),
    /// A character that no formula has.
    #[error("`{0}` has no meaning in a formula")]
    Character(char),
    /// Digits that are no finite number.
    #[error("`{0}` is not a finite number")]
    Number(String),
    /// A value is missing.
    #[error("a number, a name or `(` is missing here")]
    NoValue,
    /// Two values stand side by side.
    #[error("an operator is missing before this; a product is written with `*`, as in 5*um")]
    NoOperator,
    /// A parenthesis is not closed.
    #[error("this parenthesis is not closed")]
    Open,
    /// A parenthesis or comma without a beginning.
    #[error("nothing was opened that this `{0}` could belong to")]
    Stray(char),
    /// A name that nothing has.
    #[error("nothing is named `{name}`{help}")]
    Unknown {
        /// The name.
        name: String,
        /// A name that may have been meant, or where constants belong.
        help: String,
    },
    /// The name of a function without its arguments.
    #[error("`{0}` is a function: its arguments follow in parentheses")]
    NoArguments(String),
    /// A value is called like a function.
    #[error("`{0}` is not a function; a product is written with `*`")]
    NotAFunction(String),
    /// The wrong number of arguments.
    #[error("`{name}` takes {wanted}, and has {found}")]
    Arguments {
        /// The function.
        name: String,
        /// How many it takes, in words.
        wanted: &'static str,
        /// How many are there.
        found: usize,
    },
    /// Two values that cannot be added or compared.
    #[error("{0} and {1} cannot be added or compared; give the numbers their units, as in 2*mm")]
    Unlike(Dimension, Dimension),
    /// A function that takes pure numbers and angles only.
    #[error("this is {0}, where a pure number or an angle belongs; divide by a length first")]
    NotPure(Dimension),
    /// An exponent that depends on x and y, or has a dimension.
    #[error(
        "an exponent is a pure number that does not depend on x or y; exp(a*ln(b)) has no such limit"
    )]
    Exponent,
    /// The height is not a length.
    #[error("z is {0}, and must be a length; give the numbers their units, as in 0.01/mm")]
    NotALength(Dimension),
    /// The height is not the same on both sides of a ray from the axis.
    #[error(
        "the height jumps by {jump:.3e} mm across the ray at theta = {angle}: this angle ends there; put it \
         into sin or cos of a whole multiple, as in cos(2*theta)"
    )]
    Jump {
        /// By how much, mm.
        jump: f64,
        /// Where the ray lies, in words.
        angle: &'static str,
    },
    /// A part without x and y that has no value.
    #[error("this has no finite value")]
    NoFiniteValue,
}

impl Mistake {
    /// The mistake at its place.
    pub fn at(self, place: Range<usize>) -> Complaint {
        let mistake = self;
        Complaint { place, mistake }
    }
}
