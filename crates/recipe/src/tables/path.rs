//! `[path]`: which way the tool feeds, how far beyond the part, and how it comes and goes.

use turnpath_core::{Direction, Quantity};

use crate::diagnostic::Diagnostic;
use crate::document::Value;
use crate::place::Place;
use crate::read::{POSITIVE, Section};

pub(super) const KEYS: &[&str] = &["direction", "overrun", "lead", "clearance"];

/// How far the path rests above the part where the recipe does not say it, mm.
const CLEARANCE: f64 = 1.0;

/// How far the path runs beyond the aperture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overrun {
    /// ρ runs over the aperture exactly.
    None,
}

/// `[path]`.
pub(crate) struct PathTable {
    pub(crate) direction: Direction,
    pub(crate) overrun: Overrun,
    pub(crate) lead: bool,
    pub(crate) clearance: f64,
}

/// Reads `[path]`, which may be missing as a table but not, so far, in what it says.
pub(crate) fn path(section: &mut Section<'_>) -> PathTable {
    section.only(KEYS);
    if section.is_something_else() {
        return PathTable {
            direction: Direction::Inward,
            overrun: Overrun::None,
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
            .quantity("clearance", Quantity::Length, POSITIVE)
            .map_or(CLEARANCE, |clearance| clearance.value),
    }
}

fn overrun(section: &mut Section<'_>) -> Overrun {
    let Some(node) = section.node("overrun") else {
        refuse_default(section, "overrun", "\"contact\"", "\"none\"");
        return Overrun::None;
    };
    let place = node.place.clone();
    match &node.value {
        Value::Text(text) if text == "none" => {}
        Value::Text(text) if text.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            if section.word("overrun", &["contact", "none"]).is_some() {
                refuse(section, "overrun", place, "\"none\"");
            }
        }
        _ => {
            if section
                .quantity("overrun", Quantity::Length, POSITIVE)
                .is_some()
            {
                refuse(section, "overrun", place, "\"none\"");
            }
        }
    }
    Overrun::None
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
