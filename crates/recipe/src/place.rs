//! Where a value stands: in the recipe's text, or in the text of a `--set` argument.

use std::ops::Range;
use std::sync::Arc;

/// A text that values come from.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// The recipe's path as the user gave it, or `--set`.
    pub name: String,
    /// The whole text.
    pub text: String,
    /// 0 for the recipe, then the `--set` arguments in their order.
    pub rank: usize,
}

/// A stretch of a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    source: Arc<Source>,
    span: Range<usize>,
}

/// A value and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub place: Place,
}

impl Place {
    /// A stretch of a source, in bytes; what lies outside or inside of a character is cut off.
    pub fn new(source: Arc<Source>, span: Range<usize>) -> Self {
        let start = border(&source.text, span.start);
        let end = border(&source.text, span.end).max(start);
        Self {
            source,
            span: start..end,
        }
    }

    /// The source as a whole: a message names it and underlines nothing.
    pub fn whole(source: Arc<Source>) -> Self {
        Self { source, span: 0..0 }
    }

    /// The text that it lies in.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Start and end in bytes; empty if the source as a whole is meant.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Whether the source as a whole is meant.
    pub fn is_whole(&self) -> bool {
        self.span == (0..0)
    }
}

fn border(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at)
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}
