//! `[path]`: the direction of the feed, the overrun beyond the part, and the leads.

use turnpath_core::{Direction, Overrun, Quantity};

use crate::document::Value;
use crate::read::{Bound, NOT_NEGATIVE, Section};

pub(super) const KEYS: &[&str] = &["direction", "overrun", "lead", "clearance"];

/// Height of the path's rest above the part if the recipe does not give it, mm.
const CLEARANCE: f64 = 1.0;
/// The allowed heights: no lathe for optics has a longer travel of Z.
const REACH: Bound = Bound {
    holds: |clearance| clearance > 0.0 && clearance <= 1e3,
    words: "above zero and at most 1 m",
};

/// `[path]`.
pub(crate) struct PathTable {
    pub(crate) direction: Direction,
    pub(crate) overrun: Overrun,
    pub(crate) lead: bool,
    pub(crate) clearance: f64,
}

/// Reads `[path]`.
pub(crate) fn path(section: &mut Section<'_>) -> PathTable {
    section.report_unknown_keys(KEYS);
    if section.is_something_else() {
        return PathTable {
            direction: Direction::Inward,
            overrun: Overrun::Contact,
            lead: true,
            clearance: CLEARANCE,
        };
    }
    let direction = match section.word("direction", &["inward", "outward"]) {
        Some(word) if word.value == "outward" => Direction::Outward,
        _ => Direction::Inward,
    };
    PathTable {
        direction,
        overrun: overrun(section),
        lead: section.flag("lead").is_none_or(|lead| lead.value),
        clearance: section
            .quantity("clearance", Quantity::Length, REACH)
            .map_or(CLEARANCE, |clearance| clearance.value),
    }
}

/// `overrun` is a word or a length.
fn overrun(section: &mut Section<'_>) -> Overrun {
    let Some(node) = section.node("overrun") else {
        return Overrun::Contact;
    };
    let is_word = |text: &str| text.starts_with(|c: char| c.is_ascii_alphabetic());
    if matches!(&node.value, Value::Text(text) if is_word(text)) {
        let word = section.word("overrun", &["contact", "none"]);
        return match word {
            Some(word) if word.value == "none" => Overrun::None,
            _ => Overrun::Contact,
        };
    }
    let length = section.quantity("overrun", Quantity::Length, NOT_NEGATIVE);
    length.map_or(Overrun::Contact, |length| Overrun::Length(length.value))
}
