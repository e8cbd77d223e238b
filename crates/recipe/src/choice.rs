//! The strategy that a recipe chooses for a slot, with its parameters as written.

use turnpath_core::Slot;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Table};
use crate::place::{Located, Place};
use crate::read::Section;
use crate::suggest::quoted;

/// A slot, the strategy chosen for it, and its parameters as they stand in the recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The slot.
    pub slot: Slot,
    /// The strategy's name, a plain one.
    pub name: Located<String>,
    /// The header of the table, `[sampler]`.
    pub place: Place,
    /// The keys besides `use`, unchecked.
    pub params: Vec<Entry>,
}

impl Choice {
    /// The strategy's name.
    pub fn name(&self) -> &str {
        &self.name.value
    }

    /// A parameter as it stands in the recipe.
    pub fn param(&self, name: &str) -> Option<&Entry> {
        self.params.iter().find(|entry| entry.key == name)
    }

    /// Where a parameter's value stands; if it was left out, where the strategy is named.
    pub fn param_place(&self, name: &str) -> Place {
        self.param(name)
            .map_or(&self.name.place, |entry| &entry.node.place)
            .clone()
    }

    /// Reads the slot's table.
    pub(crate) fn read(slot: Slot, section: &mut Section<'_>) -> Option<Self> {
        let Some(table) = section.table else {
            section.missing_table(&format!("use = \"{}\"", example(slot)));
            return None;
        };
        if section.node("use").is_none() {
            section.missing("use", &format!("\"{}\"", example(slot)));
        }
        let name = section.text("use")?;
        if !is_plain(&name.value) {
            section.complain(not_plain(slot, &name));
            return None;
        }
        Some(Self {
            slot,
            name,
            place: section.place.clone(),
            params: params(table),
        })
    }
}

fn params(table: &Table) -> Vec<Entry> {
    table
        .entries()
        .iter()
        .filter(|entry| entry.key != "use")
        .cloned()
        .collect()
}

/// Whether a text can be a strategy's name: lower case letters, digits, hyphens.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    !name.is_empty() && name.chars().all(plain)
}

fn not_plain(slot: Slot, name: &Located<String>) -> Diagnostic {
    let title = format!(
        "{} cannot be the name of a {}",
        quoted(&name.value),
        slot.noun()
    );
    Diagnostic::new(name.place.clone(), title)
        .label("lower case letters, digits and hyphens only")
        .help("a strategy is chosen by its plain name, never by a file")
        .help(format!("`turnpath list {slot}` shows the names"))
}

/// A name to show when none is given.
fn example(slot: Slot) -> &'static str {
    match slot {
        Slot::Surface => "conic",
        Slot::Feed => "constant",
        Slot::Sampler => "equal-angle",
        Slot::Compensator => "z-direction",
        Slot::Velocity => "triangle-rotary",
    }
}
