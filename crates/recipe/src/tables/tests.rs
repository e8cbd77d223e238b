//! docs/recipe.md is the reference of these keys: it has each of them and no other.

use std::collections::BTreeSet;
use std::path::Path;

use turnpath_core::Quantity;

use super::{SCHEMA, TOP_KEYS};

fn page() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/recipe.md");
    std::fs::read_to_string(file).expect("docs/recipe.md")
}

/// The text below a heading, up to the next heading.
fn below<'a>(page: &'a str, heading: &str) -> &'a str {
    let heading = format!("\n## {heading}\n");
    let (_, rest) = page.split_once(&heading).expect("the heading of the table");
    rest.split_once("\n## ")
        .map_or(rest, |(section, _)| section)
}

/// The words set as code in the first column of a section's tables.
fn keys_of(section: &str) -> BTreeSet<&str> {
    let rows = section.lines().filter_map(|line| line.strip_prefix("| "));
    let cells = rows.filter_map(|row| row.split_once(" |"));
    cells.flat_map(|(cell, _)| in_code(cell)).collect()
}

fn in_code(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[test]
fn docs_recipe_md_has_every_fixed_key_and_no_other() {
    let page = page();
    let tables = SCHEMA
        .iter()
        .map(|(name, keys)| (format!("`[{name}]`"), *keys));
    let top = ("Above the first table".to_owned(), TOP_KEYS);
    for (heading, known) in tables.chain([top]) {
        let known: BTreeSet<&str> = known.iter().copied().collect();
        assert_eq!(keys_of(below(&page, &heading)), known, "{heading}");
    }
}

#[test]
fn docs_recipe_md_has_every_unit_of_every_quantity() {
    let page = page();
    for quantity in Quantity::all() {
        let start = format!("| {} | ", quantity.noun());
        let row = page.lines().find_map(|line| line.strip_prefix(&start));
        let written: Vec<&str> = in_code(row.expect("a row of the quantity")).collect();
        assert_eq!(written, quantity.units().collect::<Vec<_>>(), "{start}");
    }
}
