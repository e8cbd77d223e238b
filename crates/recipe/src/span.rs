//! The span of a value: the bytes of the recipe's text, or of a `--set` argument, that hold it.

use std::ops::Range;
use std::sync::Arc;

/// A text that values come from.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// The recipe's path as the user gave it, or `--set`.
    pub name: String,
    /// The whole text.
    pub text: String,
    /// 0 for the recipe; the `--set` arguments count from 1 in their order.
    pub rank: usize,
}

/// A range of bytes in a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    source: Arc<Source>,
    range: Range<usize>,
}

/// A value and its span.
#[derive(Debug, Clone, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// The bytes that hold it.
    pub span: Span,
}

impl Span {
    /// A range of bytes in a source. An end beyond the text moves to the end of the text, and an
    /// end inside a character moves to the start of that character.
    pub fn new(source: Arc<Source>, range: Range<usize>) -> Self {
        let start = char_boundary(&source.text, range.start);
        let end = char_boundary(&source.text, range.end).max(start);
        Self {
            source,
            range: start..end,
        }
    }

    /// The source as a whole: a message names the source and underlines nothing.
    pub fn whole(source: Arc<Source>) -> Self {
        Self {
            source,
            range: 0..0,
        }
    }

    /// The source.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Start and end in bytes; `0..0` for the source as a whole.
    pub fn range(&self) -> Range<usize> {
        self.range.clone()
    }

    /// The bytes at `place` of a text that this span holds as it is, between quotes.
    pub(crate) fn part(&self, text: &str, place: &Range<usize>) -> Option<Self> {
        let written = self.source.text.get(self.range.clone())?;
        let start = self.range.start + written.find(text)?;
        let shifted = start + place.start..(start + place.end).min(self.range.end);
        Some(Self::new(self.source.clone(), shifted))
    }

    /// Whether the span stands for the source as a whole.
    pub fn is_whole(&self) -> bool {
        self.range == (0..0)
    }
}

/// The last character boundary that is not beyond `at`.
fn char_boundary(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at)
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}
