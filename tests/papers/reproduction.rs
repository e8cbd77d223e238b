//! docs/reproduction.md: the papers' figures beside those of turnpath's runs.
//!
//! docs/reproduction.toml lists the figures. The program makes each run; every figure is held
//! against its bound, and the page against the committed one. Every run of the tests does so for the
//! small parts, and the long tests for all. To write the page:
//!
//! ```text
//! cargo xtask reference reproduction
//! ```
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod data;
mod markdown;
mod runs;
use std::fs;

use crate::support::repository;
use data::Page;
use markdown::markdown;
use runs::Runs;

/// The recipes whose figures are left to the long tests; grids are made all the same. The papers' lens
/// array has tests of its own.
const LARGE: [&str; 3] = [
    "astigmatic-50mm",
    "off-axis-paraboloid-213mm",
    "sinusoidal-array-10mm",
];

fn page() -> Page {
    let text = fs::read_to_string(repository().join("docs/reproduction.toml")).unwrap();
    toml::from_str(&text).unwrap_or_else(|error| panic!("docs/reproduction.toml: {error}"))
}

fn committed() -> String {
    fs::read_to_string(repository().join("docs/reproduction.md")).unwrap_or_default()
}

/// Makes the page's runs; gives the page as Markdown, and a complaint about each figure outside its
/// bound.
fn text_and_complaints(page: &Page) -> (String, Vec<String>) {
    let runs = Runs::of(page.calls());
    (markdown(page, &runs), page.complaints(&runs))
}

/// The page without the parts of many points: its lines stand in the committed one, in their order.
#[test]
fn the_lines_of_small_parts_are_what_the_runs_give_and_every_figure_is_within_its_bound() {
    let mut page = page();
    page.leave_out(|recipe| LARGE.contains(&recipe));
    let (text, complaints) = text_and_complaints(&page);
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
    let committed = committed();
    let mut left = committed.lines();
    for line in text.lines() {
        assert!(
            left.any(|one| one == line),
            "docs/reproduction.md does not have, or not here, what the runs give; `cargo xtask \
             reference reproduction` makes it again\n{line}"
        );
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_page_is_what_the_runs_give_and_every_figure_is_within_its_bound() {
    let (text, complaints) = text_and_complaints(&page());
    if std::env::var_os("REPRODUCTION").is_some_and(|word| word == "write") {
        fs::write(repository().join("docs/reproduction.md"), &text).unwrap();
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
    let committed = committed();
    let differs = text.lines().zip(committed.lines()).find(|(a, b)| a != b);
    assert!(
        text == committed,
        "docs/reproduction.md differs from what the runs give; `cargo xtask reference reproduction` \
         makes it again\n{differs:#?}"
    );
}

#[test]
fn figures_that_are_held_elsewhere_have_their_tests() {
    for figure in page().figures() {
        let Some(held) = &figure.held else { continue };
        let file = repository().join(&held.file);
        let text = fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", held.file));
        let function = format!("fn {}(", held.test);
        assert!(text.contains(&function), "{}: no {}", held.file, held.test);
    }
}

#[test]
fn a_figure_that_differs_has_a_reason() {
    let page = page();
    for figure in page.figures() {
        assert!(
            figure.run.is_some() != figure.held.is_some(),
            "{}: either a run or a test",
            figure.what
        );
        let differs = figure
            .expected_difference()
            .is_some_and(|part| part.abs() > 0.01);
        assert!(
            !differs || !figure.why.is_empty(),
            "{} differs from the paper and does not say why",
            figure.what
        );
    }
    for grid in page.section.iter().flat_map(|section| &section.grid) {
        let published = grid.row.iter().any(|row| !row.published.is_empty());
        assert!(!published || !grid.why.is_empty(), "{}", grid.title);
        for row in &grid.row {
            assert_eq!(row.expected.len(), grid.column.len(), "{}", row.name);
        }
    }
}
