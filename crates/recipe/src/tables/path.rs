//! `[path]`: which way the tool feeds, how far beyond the part, and how it comes and goes.

use turnpath_core::{Direction, Overrun, Quantity};

use crate::diagnostic::Diagnostic;
use crate::document::Value;
use crate::place::Place;
use crate::read::{NOT_NEGATIVE, Section};

pub(super) const KEYS: &[&str] = &["direction", "overrun", "lead"];

/// `[path]`.
pub(crate) struct PathTable {
    pub(crate) direction: Direction,
    pub(crate) overrun: Overrun,
    pub(crate) lead: bool,
}

/// Reads `[path]`.
pub(crate) fn path(section: &mut Section<'_>) -> PathTable {
    section.only(KEYS);
    if section.is_something_else() {
        return PathTable {
            direction: Direction::Inward,
            overrun: Overrun::Contact,
            lead: false,
        };
    }
    let direction = match section.word("direction", &["inward", "outward"]) {
        Some(word) if word.value == "outward" => Direction::Outward,
        _ => Direction::Inward,
    };
    PathTable {
        direction,
        overrun: overrun(section),
        lead: lead(section),
    }
}

/// A word, or a length.
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

fn lead(section: &mut Section<'_>) -> bool {
    if section.node("lead").is_none() {
        refuse_default(section, "lead", "true", "false");
        return false;
    }
    if let Some(lead) = section.flag("lead").filter(|lead| lead.value) {
        refuse(section, "lead", lead.place, "false");
    }
    false
}

fn refuse(section: &mut Section<'_>, key: &str, place: Place, instead: &str) {
    let title = format!("this version makes paths with {key} = {instead} only");
    let diagnostic = Diagnostic::new(place, title)
        .label("not made yet")
        .help(format!("write {key} = {instead} under [path]"));
    section.complain(diagnostic);
}

fn refuse_default(section: &mut Section<'_>, key: &str, default: &str, instead: &str) {
    let title = format!("this version makes paths with {key} = {instead} only");
    let mut diagnostic = Diagnostic::new(section.place.clone(), title);
    if section.table.is_some() {
        diagnostic = diagnostic.label(format!("without `{key}` it is {default}, not made yet"));
    }
    section.complain(diagnostic.help(format!(
        "write {key} = {instead} under [path]; the default {default} is not made yet"
    )));
}
