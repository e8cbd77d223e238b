//! The strategy that a recipe chooses for a slot, with the parameters as the recipe gives them.

use std::ops::Range;

use turnpath_core::Slot;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Table, Value};
use crate::read::Section;
use crate::span::{Span, Spanned};
use crate::suggest::quoted;
use crate::tables::{DEFAULT_SPINDLE, USE, slot_keys};

/// A slot, the strategy chosen for it, and the parameters as the recipe gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The slot.
    pub slot: Slot,
    /// The path of the slot's table, `sampler`; of a surface of several `surface.0` and so on.
    pub path: String,
    /// The strategy's name: lower-case letters, digits and hyphens.
    pub name: Spanned<String>,
    /// The header of the slot's table, `[sampler]`.
    pub span: Span,
    /// The keys that belong to the strategy. They are not checked yet.
    pub params: Vec<Entry>,
}

impl Choice {
    /// The strategy's name.
    pub fn name(&self) -> &str {
        &self.name.value
    }

    /// A parameter as the recipe gives it.
    pub fn param(&self, name: &str) -> Option<&Entry> {
        self.params.iter().find(|entry| entry.key == name)
    }

    /// The span of a parameter's value, or of the strategy's name if the recipe leaves the
    /// parameter out.
    pub fn param_span(&self, name: &str) -> Span {
        self.param(name)
            .map_or(&self.name.span, |entry| &entry.node.span)
            .clone()
    }

    /// The span of the bytes at `place` in a parameter's text; that of the whole value if the recipe
    /// writes the text with escapes.
    pub fn place_span(&self, name: &str, place: &Range<usize>) -> Span {
        let whole = self.param_span(name);
        match self.param(name).map(|entry| &entry.node.value) {
            Some(Value::Text(text)) => whole.part(text, place).unwrap_or(whole),
            _ => whole,
        }
    }

    fn read_name(slot: Slot, section: &mut Section<'_>) -> Option<Spanned<String>> {
        let key = USE.name();
        if section.node(key).is_some() {
            return section.text(key);
        }
        if slot == Slot::Spindle {
            return Some(Spanned {
                value: DEFAULT_SPINDLE.to_owned(),
                span: section.span.clone(),
            });
        }
        section.missing(key, &format!("\"{}\"", example(slot)));
        None
    }

    /// Reads the slot's table.
    pub(crate) fn read(slot: Slot, section: &mut Section<'_>) -> Option<Self> {
        let Some(table) = section.table else {
            if slot == Slot::Spindle {
                // The table's own reader reports that it is missing.
                return None;
            }
            section.missing_table(&format!("use = \"{}\"", example(slot)));
            return None;
        };
        let name = Self::read_name(slot, section)?;
        if is_no_name(&name.value) {
            section.report(invalid_name(slot, &name));
            return None;
        }
        Some(Self {
            slot,
            path: section.name.to_owned(),
            name,
            span: section.span.clone(),
            params: params(slot, table),
        })
    }
}

fn params(slot: Slot, table: &Table) -> Vec<Entry> {
    let of_host = |key: &str| slot_keys(slot).iter().any(|info| info.name == key);
    let entries = table.entries().iter();
    entries
        .filter(|entry| !of_host(&entry.key))
        .cloned()
        .collect()
}

/// Whether the text is empty or looks like a file. Another misspelt name may come near to a known one,
/// which is found later.
fn is_no_name(name: &str) -> bool {
    name.trim().is_empty() || name.contains(['/', '\\', '.'])
}

fn invalid_name(slot: Slot, name: &Spanned<String>) -> Diagnostic {
    let title = format!(
        "{} cannot be the name of a {}",
        quoted(&name.value),
        slot.noun()
    );
    Diagnostic::new(name.span.clone(), title)
        .with_label("only lower-case letters, digits and hyphens")
        .with_help("a recipe chooses a strategy by its name, never by a file")
        .with_help(format!("`turnpath list {slot}` shows the names"))
}

/// A strategy's name for an example.
fn example(slot: Slot) -> &'static str {
    match slot {
        Slot::Surface => "conic",
        Slot::Feed => "constant",
        Slot::Sampler => "equal-angle",
        Slot::Compensator => "z-direction",
        Slot::Velocity => "triangle-rotary",
        Slot::Spindle => DEFAULT_SPINDLE,
    }
}
