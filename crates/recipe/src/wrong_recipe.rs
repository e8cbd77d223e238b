//! A recipe that cannot be read as a whole: what is wrong, and the strategies that it chooses.

use turnpath_core::Slot;

use crate::choice::Choice;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Table;
use crate::read::Sections;
use crate::span::Span;
use crate::surface_entry::surface_entries;
use crate::tables;

/// What is wrong with a recipe, and the strategies that it chooses as far as they can be read. Whoever
/// knows the strategies can so say in one go what else is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{messages}")]
pub struct WrongRecipe {
    messages: Diagnostics,
    choices: Vec<Choice>,
}

impl WrongRecipe {
    /// A recipe with these messages.
    pub(crate) fn new(messages: Diagnostics, choices: Vec<Choice>) -> Self {
        Self { messages, choices }
    }

    /// What is wrong.
    pub fn messages(&self) -> &Diagnostics {
        &self.messages
    }

    /// The strategies that could be read. There are none if the recipe lists plugins: the plugins of a
    /// wrong recipe are not loaded, so nobody knows which strategies there are.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// The same with more messages.
    #[must_use]
    pub fn with_messages(mut self, more: impl IntoIterator<Item = Diagnostic>) -> Self {
        self.messages = self.messages.and(more);
        self
    }
}

impl From<Diagnostics> for WrongRecipe {
    fn from(messages: Diagnostics) -> Self {
        Self::new(messages, Vec::new())
    }
}

/// The strategies that a document chooses, as far as they can be read; see [`WrongRecipe::choices`].
pub(crate) fn readable_choices(document: &Table, whole: &Span) -> Vec<Choice> {
    let mut messages = Vec::new();
    let mut sections = Sections {
        root: document,
        whole,
        schema: tables::SCHEMA,
        diagnostics: &mut messages,
    };
    if tables::may_list_plugins(document) || !tables::format_is_one(&mut sections.top()) {
        return Vec::new();
    }
    let surfaces = surface_entries(&mut sections).unwrap_or_default();
    let surfaces = surfaces.into_iter().map(|entry| entry.choice);
    let others = Slot::ALL.into_iter().filter(|slot| *slot != Slot::Surface);
    let others = others.filter_map(|slot| Choice::read(slot, &mut sections.open(slot.key())));
    surfaces.chain(others).collect()
}
