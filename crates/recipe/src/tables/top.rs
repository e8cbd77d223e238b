//! The keys above the first table, and the names of the tables.

use turnpath_core::Slot;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Table, Value};
use crate::place::Located;
use crate::read::{Section, tables_with};
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::SCHEMA;
use crate::value;

/// Keys above the first table.
pub(crate) const KEYS: &[&str] = &["format", "name", "plugins", "refine"];

/// The only format so far.
const FORMAT: f64 = 1.0;

/// What stands above the first table.
pub(crate) struct Top {
    pub(crate) name: Option<String>,
    pub(crate) plugins: Vec<Located<String>>,
    pub(crate) refine: bool,
}

/// Reads the keys above the first table, and complains about unknown tables.
pub(crate) fn top(section: &mut Section<'_>) -> Top {
    only_known(section);
    let name = section.text("name");
    if let Some(empty) = name.as_ref().filter(|name| name.value.trim().is_empty()) {
        let title = "`name` is empty";
        section.complain(
            Diagnostic::new(empty.place.clone(), title)
                .help("leave it out, or give the job a name"),
        );
    }
    Top {
        name: name.map(|name| name.value),
        plugins: section.texts("plugins").unwrap_or_default(),
        refine: section.flag("refine").is_none_or(|refine| refine.value),
    }
}

/// Whether the recipe is of the format that this version reads; complains if not.
pub(crate) fn format_is_one(section: &mut Section<'_>) -> bool {
    let Some(node) = section.node("format") else {
        section.missing("format", "1");
        return true;
    };
    match value::number("format", node) {
        Ok(FORMAT) => true,
        Ok(other) => {
            let title = format!("the recipe is of format {other}, and this version reads format 1");
            let diagnostic = Diagnostic::new(node.place.clone(), title)
                .label("must be 1")
                .help("take a version of turnpath that reads it, or write format = 1");
            section.complain(diagnostic);
            false
        }
        Err(diagnostic) => {
            section.complain(diagnostic);
            false
        }
    }
}

fn only_known(section: &mut Section<'_>) {
    for entry in section.table.map_or(&[][..], Table::entries) {
        let is_table = matches!(entry.node.value, Value::Table(_));
        let key = entry.key.as_str();
        let complaint = match (table_names().contains(&key), KEYS.contains(&key)) {
            (true, _) if is_table => continue,
            (true, _) => not_a_table(entry),
            (_, true) => continue,
            _ if is_table => unknown_table(entry),
            _ => unknown_key(entry),
        };
        section.complain(complaint);
    }
}

fn table_names() -> Vec<&'static str> {
    let slots = Slot::ALL.iter().map(|slot| slot.key());
    let fixed = SCHEMA.iter().map(|(name, _)| *name);
    fixed
        .filter(|name| !name.contains('.'))
        .chain(slots)
        .collect()
}

fn not_a_table(entry: &Entry) -> Diagnostic {
    let key = &entry.key;
    value::wrong_type(key, &entry.node, "a table")
        .help(format!("write the line [{key}], and its keys below it"))
}

fn unknown_table(entry: &Entry) -> Diagnostic {
    let names = table_names();
    Diagnostic::new(
        entry.node.place.clone(),
        format!("unknown table {}", quoted(&entry.key)),
    )
    .label("unknown table")
    .helps(did_you_mean(&entry.key, &names))
    .help(format!("tables: {}", listed(&names)))
}

fn unknown_key(entry: &Entry) -> Diagnostic {
    let key = entry.key.as_str();
    let elsewhere = || tables_with(key).map(|tables| format!("`{key}` belongs to {tables}"));
    let known: Vec<&str> = KEYS.iter().copied().chain(table_names()).collect();
    Diagnostic::new(entry.place.clone(), format!("unknown key {}", quoted(key)))
        .label("unknown key")
        .helps(did_you_mean(key, &known).or_else(elsewhere))
        .help(format!("keys above the first table: {}", listed(KEYS)))
}
