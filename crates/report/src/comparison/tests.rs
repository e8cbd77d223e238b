//! Widths, marks and figures.

use unicode_width::UnicodeWidthStr;

use crate::AblationRun;
use crate::sample::{failed_run, measured_run};
use crate::unit;

use super::{all, table, usual};

/// A run that varies its sampler.
fn entry(label: &str, points: u64, error_nm: f64) -> AblationRun {
    let error = error_nm / unit::nm::PER;
    measured_run(varied(label), |run| {
        let report = &mut run.report;
        report.control_points = points;
        report.points_added_by_refine = 0;
        report.revolutions = 104.166;
        report.cutting_time = 1.25e6;
        report.path.interpolation_error.max = error;
        report.path.interpolation_error.rms = error / 3.0;
        report.path.residual.max = Some(99.96 / unit::nm::PER);
        report.path.axes.z.acceleration.rms = 12_345.6;
        if let Some(axes) = &mut report.axes_of_law {
            axes.x.acceleration.rms = 0.0123;
        }
        report.within.interpolation = Some(error_nm < 100.0);
        report.within.machine = Some(error_nm < 100.0);
        run.program_bytes = Some(1_234_567);
        run.planning_time = Some(0.0042);
        run.measuring_time = Some(0.0031);
    })
}

fn failed(label: &str, reason: &str) -> AblationRun {
    failed_run(varied(label), reason)
}

fn varied(label: &str) -> Vec<(String, String)> {
    let pair = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    vec![pair("sampler", label), pair("tolerance.residual", "100 nm")]
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
    for columns in [usual(), all(), all().into_iter().rev().collect()] {
        for widest in [40, 57, 80, 100] {
            let text = table(&entries, &columns, widest, entries.first());
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
    insta::assert_snapshot!(table(&entries, &usual(), 100, entries.first()));
}

#[test]
fn a_first_run_that_failed_leaves_no_ratios() {
    let entries = [
        failed("panics", "it panicked"),
        entry("equal-arc", 1_300, 98.0),
    ];
    let text = table(&entries, &usual(), 100, entries.first());
    assert!(!text.contains('×'), "{text}");
}

/// Two strategies of one name differ at the ends of their labels, and so do two groups.
#[test]
fn labels_that_are_too_long_go_on_below_themselves() {
    let rows = |feed: &str, other: &str| {
        let pair = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        measured_run(vec![pair("sampler", other), pair("feed", feed)], |_| ())
    };
    let group = "equal-arc (spacing = 0.25 mm), and more of it to fill a line, and then 1";
    let entries = [
        rows("constant (feed = 10 um/rev, of a laboratory)", group),
        rows("constant (feed = 20 um/rev, of a laboratory)", group),
        rows("atpg", &group.replace("then 1", "then 2")),
    ];
    for columns in [usual(), all()] {
        for widest in [40, 100] {
            let text = table(&entries, &columns, widest, entries.first());
            assert_narrow(&text, widest);
            for one in ["= 10", "= 20", "then 1", "then 2"] {
                assert!(text.contains(one), "{text}");
            }
        }
    }
}
