//! docs/reproduction.md: the papers' figures beside those of turnpath's runs.
//!
//! docs/reproduction.toml lists the figures. The program makes each run; every figure is held
//! against its bound, and the page against the committed one. To write the page:
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

fn page() -> Page {
    let text = fs::read_to_string(repository().join("docs/reproduction.toml")).unwrap();
    toml::from_str(&text).unwrap_or_else(|error| panic!("docs/reproduction.toml: {error}"))
}

#[test]
fn the_page_is_what_the_runs_give_and_every_figure_is_within_its_bound() {
    let page = page();
    let runs = Runs::of(page.calls());
    let text = markdown(&page, &runs);
    let file = repository().join("docs/reproduction.md");
    if std::env::var_os("REPRODUCTION").is_some_and(|word| word == "write") {
        fs::write(&file, &text).unwrap();
    }
    let complaints = page.complaints(&runs);
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
    let committed = fs::read_to_string(&file).unwrap_or_default();
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
