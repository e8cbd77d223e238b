//! Widths, marks and figures.

use serde_json::json;

use crate::ablate::columns::{ALL, chosen};

use super::*;

fn entry(label: &str, points: u64, error: f64) -> Value {
    json!({
        "varied": { "sampler": label, "tolerance.residual": "100 nm" },
        "control_points": points,
        "points_added_by_refine": 0,
        "revolutions": 104.166,
        "cutting_time_s": 1.25e6,
        "interpolation_error_nm": { "max": error, "rms": error / 3.0 },
        "residual_nm": { "max": 99.96 },
        "axes": {
            "z": { "rms_acceleration": 12_345.6 },
        },
        "axes_of_law": {
            "x": { "rms_acceleration": 0.0123 },
        },
        "within": { "interpolation": error < 100.0, "residual": true, "machine": error < 100.0 },
        "program_bytes": 1_234_567,
        "planning_time_s": 0.0042,
    })
}

fn failed(label: &str, reason: &str) -> Value {
    json!({
        "varied": { "sampler": label, "tolerance.residual": "100 nm" },
        "error": reason,
    })
}

#[track_caller]
fn assert_narrow(text: &str, widest: usize) {
    for line in text.lines() {
        assert!(line.width() <= widest, "{}: {line}", line.width());
    }
}

#[test]
fn no_label_reason_or_choice_of_columns_makes_it_wider_than_the_terminal() {
    let long = "a-strategy-of-a-long-name (parameter = 3 um, other = 度度度度度度度度度度度度)";
    let reason = "the tool would gouge: ".repeat(20);
    let entries = [
        entry(long, 123_456_789, 1e-9),
        entry("atpg", 2_655, 98.78),
        failed(long, &reason),
        entry("x", 5, 1e12),
    ];
    for columns in [
        chosen(&[]),
        ALL.iter().collect(),
        ALL.iter().rev().collect(),
    ] {
        for widest in [40, 57, 80, 100] {
            let text = table(&entries, &columns, widest);
            assert_narrow(&text, widest);
            assert!(text.contains("failed: the tool"), "{text}");
            for one in ["1.0e12", "!1", "×"] {
                assert!(text.contains(one), "{text}");
            }
        }
    }
}

#[test]
fn the_smallest_of_a_column_is_marked_and_what_exceeds_its_tolerance() {
    let entries = [
        entry("equal-angle", 2_655, 98.78),
        failed("panics", "the sampler panicked"),
        entry("equal-arc", 1_300, 198.0),
    ];
    insta::assert_snapshot!(table(&entries, &chosen(&[]), 100));
}

#[test]
fn a_first_run_that_failed_leaves_no_ratios() {
    let entries = [
        failed("panics", "it panicked"),
        entry("equal-arc", 1_300, 98.0),
    ];
    let text = table(&entries, &chosen(&[]), 100);
    assert!(!text.contains('×'), "{text}");
}

/// Two strategies of one name differ at the ends of their labels, and so do two groups.
#[test]
fn labels_that_are_too_long_go_on_below_themselves() {
    let rows = |feed: &str, other: &str| {
        json!({
            "varied": { "sampler": other, "feed": feed },
            "control_points": 5,
        })
    };
    let group = "equal-arc (spacing = 0.25 mm), and more of it to fill a line, and then 1";
    let entries = [
        rows("constant (feed = 10 um/rev, of a laboratory)", group),
        rows("constant (feed = 20 um/rev, of a laboratory)", group),
        rows("atpg", &group.replace("then 1", "then 2")),
    ];
    for columns in [chosen(&[]), ALL.iter().collect()] {
        for widest in [40, 100] {
            let text = table(&entries, &columns, widest);
            assert_narrow(&text, widest);
            for one in ["= 10", "= 20", "then 1", "then 2"] {
                assert!(text.contains(one), "{text}");
            }
        }
    }
}
