//! The strategies that the program contains by default.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;

/// Slot and name of every built-in strategy.
const BUILT_INS: [(&str, &[&str]); 6] = [
    (
        "surface",
        &[
            "astigmatic",
            "biconic",
            "chebyshev",
            "conic",
            "even-asphere",
            "forbes-q2d",
            "forbes-qbfs",
            "forbes-qcon",
            "formula",
            "grid-sag",
            "lenslet-array",
            "odd-asphere",
            "off-axis-conic",
            "off-axis-paraboloid",
            "sinusoidal-array",
            "toric",
            "toroid-yz",
            "xy-polynomial",
            "zernike",
        ],
    ),
    ("feed", &["atpg", "ats", "constant", "fft-adaptive"]),
    (
        "sampler",
        &[
            "atpg",
            "ats",
            "equal-angle",
            "equal-arc",
            "fft-adaptive",
            "integrated",
            "minimax",
        ],
    ),
    ("compensator", &["none", "normal", "z-direction"]),
    (
        "velocity",
        &[
            "analytic",
            "area",
            "linear",
            "three-point",
            "triangle-rotary",
        ],
    ),
    ("spindle", &["constant", "per-revolution", "surface-speed"]),
];

/// Slot and name of each line of a list.
fn listed(text: &str) -> Vec<(String, Vec<String>)> {
    let mut slots: Vec<(String, Vec<String>)> = Vec::new();
    for line in text.lines() {
        match (line.strip_prefix("  "), slots.last_mut()) {
            (Some(entry), Some((_, names))) => {
                let (name, summary) = entry.split_once("  ").expect("a name and a summary");
                assert!(!summary.trim().is_empty(), "{line}");
                names.push(name.trim().to_owned());
            }
            _ => slots.push((line.to_owned(), Vec::new())),
        }
    }
    slots
}

fn expected(only: Option<&str>) -> Vec<(String, Vec<String>)> {
    BUILT_INS
        .iter()
        .filter(|(slot, _)| only.is_none_or(|only| only == *slot))
        .map(|(slot, names)| {
            let names = names.iter().map(|name| (*name).to_owned());
            ((*slot).to_owned(), names.collect())
        })
        .collect()
}

#[test]
fn the_list_names_exactly_the_built_ins() {
    let said = Bench::empty().line("list").ends(0);
    assert_eq!(listed(&said.stdout), expected(None));
    assert_eq!(said.stderr, "");
}

#[test]
fn the_list_of_a_slot_names_that_slot_alone() {
    for (slot, _) in BUILT_INS {
        let said = Bench::empty().call(["list", slot]).ends(0);
        assert_eq!(listed(&said.stdout), expected(Some(slot)));
    }
}

#[test]
fn every_built_in_is_explained_with_and_without_its_slot() {
    let bench = Bench::empty();
    for (slot, names) in BUILT_INS {
        for name in names {
            let full = format!("{slot}/{name}");
            let said = bench.call(["explain", &full]).ends(0);
            assert!(said.stdout.starts_with(&format!("{full}: ")), "{said}");
            let use_line = format!("\n  [{slot}]\n  use = \"{name}\"\n");
            assert!(said.stdout.contains(&use_line), "{said}");
            // A name that two slots have explains both.
            let without = bench.call(["explain", name]).ends(0);
            assert!(without.stdout.contains(&said.stdout), "{without}");
        }
    }
}

/// The text without version numbers: a release changes no snapshot.
fn explained(name: &str) -> String {
    let said = Bench::empty().call(["explain", name]).ends(0);
    said.stdout.replace(env!("CARGO_PKG_VERSION"), "[version]")
}

#[test]
fn a_sampler_explained() {
    insta::assert_snapshot!(explained("equal-angle"));
}

#[test]
fn a_feed_explained() {
    insta::assert_snapshot!(explained("feed/constant"));
}

#[test]
fn a_surface_with_rows_explained() {
    insta::assert_snapshot!(explained("xy-polynomial"));
}

#[test]
fn a_surface_with_a_choice_explained() {
    insta::assert_snapshot!(explained("sinusoidal-array"));
}

#[test]
fn a_velocity_solver_explained() {
    insta::assert_snapshot!(explained("velocity/triangle-rotary"));
}

#[test]
fn a_table_explained() {
    insta::assert_snapshot!(explained("tool"));
}

#[test]
fn a_table_with_words_lists_and_texts_explained() {
    let text = ["recipe", "path", "output", "output.pmac-pvt"].map(explained);
    insta::assert_snapshot!(text.join("\n"));
}

#[test]
fn a_slot_explained() {
    insta::assert_snapshot!(explained("sampler"));
}

#[test]
fn every_table_is_explained_with_all_its_keys() {
    for table in turnpath::tables().filter(|table| !table.name.is_empty()) {
        let text = explained(table.name);
        assert!(text.starts_with(&format!("{}: {}\n", table.name, table.summary)));
        for key in table.names() {
            assert!(text.contains(&format!("\n  {key} = ")), "{key}");
        }
    }
}

#[test]
fn a_slot_that_does_not_exist_is_a_wrong_call() {
    let bench = Bench::empty();
    insta::assert_snapshot!("list_of_no_slot", bench.shown(&bench.line("list surfaces")));
    let said = bench.line("explain nose/normal");
    insta::assert_snapshot!("explain_of_no_slot", bench.shown(&said));
}

#[test]
fn a_name_that_does_not_exist_is_a_wrong_call() {
    let bench = Bench::empty();
    let said = bench.line("explain astigmatik");
    insta::assert_snapshot!("explain_misspelt", bench.shown(&said));
    let said = bench.line("explain tolerances");
    insta::assert_snapshot!("explain_of_a_misspelt_table", bench.shown(&said));
    let said = bench.line("explain velocity/normal");
    insta::assert_snapshot!("explain_of_another_slot", bench.shown(&said));
    let said = bench.line("explain something-else-altogether");
    insta::assert_snapshot!("explain_unknown", bench.shown(&said));
}
