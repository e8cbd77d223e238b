//! docs/recipe.md is the reference of these keys: its tables are written from the declarations.
//!
//! `cargo xtask reference recipe` writes them again.

use std::path::{Path, PathBuf};

use turnpath_core::{ParamDefault, ParamInfo, ParamKind, Quantity};

use super::{surface, tables};
use crate::declared::{kind, limits, shown};
use crate::table_info::TableInfo;

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/recipe.md")
}

fn page() -> String {
    std::fs::read_to_string(file()).expect("docs/recipe.md")
}

/// The keys that place a surface.
static PLACE: TableInfo = TableInfo {
    name: "surface",
    summary: "the place of a surface in a sum",
    required: true,
    keys: surface::KEYS.split_at(1).1,
};

/// The line above the table of some keys.
fn marker(table: &TableInfo) -> String {
    let of = match table.name {
        "" => "the keys above the first table".to_owned(),
        name => format!("[{name}]"),
    };
    format!("<!-- {of}: `cargo xtask reference recipe` writes this table -->\n")
}

fn in_code(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
    words.join(", ")
}

fn value(key: &ParamInfo) -> String {
    match key.kind {
        ParamKind::Choice(words) => in_code(words),
        ParamKind::ChoiceOr(words, quantity) => {
            format!("{}, or {}", in_code(words), quantity.noun())
        }
        ParamKind::List(words) if !words.is_empty() => format!("a list of {}", in_code(words)),
        _ => kind(key),
    }
}

fn default(key: &ParamInfo) -> String {
    match key.default {
        ParamDefault::Required => "required".to_owned(),
        ParamDefault::Absent => "may be left out".to_owned(),
        ParamDefault::Number(number) => match key.kind.quantity() {
            Some(_) => format!("`\"{}\"`", shown(key.kind, number)),
            None => number.to_string(),
        },
        ParamDefault::Flag(flag) => format!("`{flag}`"),
        ParamDefault::Text(word) => format!("`\"{word}\"`"),
        ParamDefault::List(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
            format!("`[{}]`", words.join(", "))
        }
    }
}

/// The table of a table's keys. Keys that differ by name alone share a row.
fn rows(table: &TableInfo) -> String {
    let mut rows: Vec<(Vec<String>, String)> = Vec::new();
    for key in table.keys {
        let cells = [value(key), key.help.to_owned(), default(key), limits(key)];
        let cells = cells.join(" | ");
        let name = format!("`{}`", key.name);
        match rows.iter_mut().find(|(_, other)| *other == cells) {
            Some((names, _)) => names.push(name),
            None => rows.push((vec![name], cells)),
        }
    }
    let rows = rows.iter().map(|(names, cells)| {
        let row = format!("| {} | {cells} |", names.join(", "));
        row.replace("|  |", "| |") + "\n"
    });
    format!(
        "| key | value | what | default | limits |\n|---|---|---|---|---|\n{}",
        rows.collect::<String>()
    )
}

/// The page with the table below each marker written anew.
fn written(page: &str) -> String {
    let mut page = page.to_owned();
    for table in tables().chain([&PLACE]) {
        let marker = marker(table);
        let (before, after) = page
            .split_once(&marker)
            .unwrap_or_else(|| panic!("docs/recipe.md has no line {marker}"));
        let old = after.split_inclusive('\n');
        let old: usize = old
            .take_while(|line| line.starts_with('|'))
            .map(str::len)
            .sum();
        page = format!("{before}{marker}{}{}", rows(table), &after[old..]);
    }
    page
}

#[test]
fn docs_recipe_md_has_the_declared_keys() {
    let page = page();
    let written = written(&page);
    if std::env::var_os("RECIPE_PAGE").is_some_and(|how| how == "write") {
        std::fs::write(file(), &written).expect("docs/recipe.md is written");
        return;
    }
    let differs = page
        .lines()
        .zip(written.lines())
        .find(|(is, should)| is != should);
    assert_eq!(differs, None, "cargo xtask reference recipe");
    assert_eq!(page, written);
}

#[test]
fn every_key_has_help_and_every_table_a_name_of_its_own() {
    let all: Vec<&TableInfo> = tables().chain([&PLACE]).collect();
    for (i, table) in all.iter().enumerate() {
        assert!(!table.summary.is_empty());
        assert!(all[..i].iter().all(|other| other.name != table.name));
        for (k, key) in table.keys.iter().enumerate() {
            assert!(
                !key.help.is_empty() && !key.help.contains('|'),
                "{}",
                key.name
            );
            assert!(table.keys[..k].iter().all(|other| other.name != key.name));
        }
    }
}

#[test]
fn docs_recipe_md_has_every_unit_of_every_quantity() {
    let page = page();
    for quantity in Quantity::all() {
        let start = format!("| {} | ", quantity.noun());
        let row = page.lines().find_map(|line| line.strip_prefix(&start));
        let row = row.expect("a row of the quantity");
        let written: Vec<&str> = row.split('`').skip(1).step_by(2).collect();
        assert_eq!(written, quantity.units().collect::<Vec<_>>(), "{start}");
    }
}
