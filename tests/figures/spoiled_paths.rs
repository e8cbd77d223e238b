//! Paths that were spoiled by hand, in the cut, near its ends and on leads: `turnpath verify` reports
//! each with its place, whether or not a tolerance is exceeded.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::OnceLock;

use crate::support::bench::{Answer, Bench};
use serde_json::Value;

const AST_5: &str = include_str!("../../docs/recipes/astigmatic-5mm.toml");

/// Columns of `toolpath.csv`.
const C: usize = 1;
const X: usize = 2;
const Z: usize = 3;
const VC: usize = 4;
const VX: usize = 5;
const VZ: usize = 6;
const SECTION: usize = 7;

/// AST-5 as its recipe makes it, run once.
fn made() -> &'static Bench {
    static MADE: OnceLock<Bench> = OnceLock::new();
    MADE.get_or_init(|| {
        let bench = Bench::with(AST_5);
        bench.line("run recipe.toml -o out").ends(0);
        bench
    })
}

/// The lines of its table; the header is line 0, so a line's number is that of its control point.
fn table() -> Vec<String> {
    lines_of("out/toolpath.csv")
}

fn lines_of(file: &str) -> Vec<String> {
    made().read(file).lines().map(String::from).collect()
}

fn value(line: &str, column: usize) -> f64 {
    line.split(',').nth(column).unwrap().parse().unwrap()
}

/// What `verify` reports of these lines; each test has a file of its own.
fn verify(name: &str, lines: &[String]) -> Answer {
    made().write(name, lines.join("\n") + "\n");
    made().line(&format!("verify recipe.toml {name} --format json"))
}

/// A row of the table with another value in one column.
fn edited(row: usize, column: usize, change: impl FnOnce(f64) -> f64) -> Vec<String> {
    let mut lines = table();
    let mut values: Vec<String> = lines[row].split(',').map(String::from).collect();
    values[column] = change(value(&lines[row], column)).to_string();
    lines[row] = values.join(",");
    lines
}

/// The first and the last row that cut.
fn cut() -> (usize, usize) {
    let lines = table();
    let cuts = |line: &String| line.ends_with(",1");
    let first = lines.iter().position(cuts).unwrap();
    (first, lines.iter().rposition(cuts).unwrap())
}

/// Rows near the ends of the path, in both leads, at both joins, and along the cut.
fn rows() -> Vec<usize> {
    let (first, last) = cut();
    let end = table().len() - 1;
    let joins = [first - 1, first, first + 1, last - 1, last, last + 1];
    let along = [first + 20, 800, 1500, 2000, 2500, 3000, last - 100];
    let leads = [2, 5, 120, last + 50, end - 5, end - 1];
    [&joins[..], &along, &leads].concat()
}

/// The only anomaly lies at this row, or at the one beside it.
#[track_caller]
fn told_at(said: &Answer, row: usize, what: &[&str]) {
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let verified = said.json();
    let anomalies = &verified["anomalies"];
    assert_eq!(anomalies["count"], 1, "row {row}: {anomalies}");
    let place = &anomalies["places"][0];
    let point = place["point"].as_u64().unwrap();
    assert!(point.abs_diff(row as u64) <= 1, "row {row}: {place}");
    let found = place["kind"].as_str().unwrap();
    assert!(what.contains(&found), "row {row}: {place}");
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap()
}

#[test]
fn a_path_as_it_was_written_has_no_anomaly_in_either_file() {
    for file in ["out/toolpath.csv", "out/recipe.pmc"] {
        let said = made().line(&format!("verify recipe.toml {file} --format json"));
        let verified = said.ends(0).json();
        assert_eq!(verified["anomalies"]["count"], 0, "{file}");
        // A table gives the doubles back, a program seven decimals of Z, X and C in deg.
        let digits = if file.ends_with("csv") { 1e-6 } else { 0.1 };
        let error = number(&verified, "/control_point_error/max_nm");
        assert!(error < digits, "{file}: {error} nm");
    }
}

#[test]
fn a_point_that_is_moved_by_50_nm_is_told() {
    for row in rows() {
        let said = verify("z50.csv", &edited(row, Z, |z| z + 50e-6));
        told_at(&said, row, &["z_position", "z_motion"]);
        let (first, last) = cut();
        if (first..=last).contains(&row) {
            let error = number(&said.json(), "/control_point_error/max_nm");
            assert!((error - 50.0).abs() < 0.01, "{error} nm");
        }
        let said = verify("x50.csv", &edited(row, X, |x| x + 50e-6));
        told_at(&said, row, &["z_position", "x_motion"]);
    }
}

/// An error of a hundredth of a velocity is not reported if it displaces the path by less than a
/// thousandth of the tolerance: 0.01 v · h · 4/27 with steps of 2 to 26 ms.
#[test]
fn a_velocity_that_is_wrong_by_a_hundredth_is_reported_with_its_axis() {
    let step = |row: usize| {
        let lines = table();
        let t = |row: usize| value(&lines[row], 0);
        (t(row + 1) - t(row)).min(t(row) - t(row - 1))
    };
    let matters = |row: usize, column: usize, per_unit: f64| {
        let v = value(&table()[row], column) * per_unit;
        (0.01 * v * step(row) * 4.0 / 27.0).abs() > 2.0 * 1e-7
    };
    let rim = 2.5 * std::f64::consts::PI / 180.0;
    let mut reported = [0; 3];
    for row in rows() {
        for (k, (column, per_unit, what)) in [
            (VC, rim, "c_motion"),
            (VX, 1.0, "x_motion"),
            (VZ, 1.0, "z_motion"),
        ]
        .into_iter()
        .enumerate()
        {
            if matters(row, column, per_unit) {
                let said = verify("v.csv", &edited(row, column, |v| 1.01 * v));
                told_at(&said, row, &[what]);
                reported[k] += 1;
            }
        }
    }
    assert!(
        reported[0] >= 15 && reported[1] >= 6 && reported[2] >= 9,
        "{reported:?}"
    );
}

#[test]
fn a_velocity_that_is_wrong_where_it_matters_exceeds_the_tolerance_there() {
    let c = value(&table()[2000], C);
    let said = verify("vz.csv", &edited(2000, VZ, |v| 1.01 * v)).ends(1);
    let verified = said.json();
    assert_eq!(verified["within"]["interpolation"], false);
    let at = number(&verified, "/interpolation_error/at/c_deg");
    assert!(
        (at - c).abs() <= 30.0,
        "found at {at} deg, wrong at {c} deg"
    );
}

#[test]
fn a_row_that_is_lost_is_reported() {
    let (first, last) = cut();
    for row in [
        30,
        120,
        first,
        first + 1,
        800,
        1500,
        2000,
        3000,
        last - 1,
        last,
    ] {
        let mut lines = table();
        lines.remove(row);
        told_at(
            &verify("lost.csv", &lines),
            row,
            &["c_motion", "x_motion", "z_motion"],
        );
    }
}

#[test]
fn the_text_reports_an_anomaly_and_the_tolerance_decides() {
    made().write("told.csv", edited(2000, Z, |z| z + 50e-6).join("\n") + "\n");
    let said = made().line("verify recipe.toml told.csv").ends(0);
    let line = "  anomalies       point 2,000, C = ";
    assert!(said.stdout.contains(line), "{said}");
    assert!(
        said.stdout.contains("Z is off the first touch by 50.00 nm"),
        "{said}"
    );
}

#[test]
fn rows_that_are_swapped_are_refused_with_their_line() {
    let (first, last) = cut();
    for row in [2, 120, first, 2000, last - 1, last + 50] {
        let mut lines = table();
        lines.swap(row, row + 1);
        let said = verify("swapped.csv", &lines).ends(4);
        // The header is the file's first line; the second of both comes too early.
        let place = format!("swapped.csv, line {}: ", row + 2);
        assert!(said.stderr.contains(&place), "row {row}: {said}");
    }
}

#[test]
fn a_value_that_is_no_number_is_refused_with_its_line() {
    let (first, last) = cut();
    for row in [1, 120, first, 2000, last, last + 50] {
        for column in [0, C, X, Z, VC, VX, VZ, SECTION] {
            let lines = edited(row, column, |_| f64::NAN);
            let said = verify("nan.csv", &lines).ends(4);
            let place = format!("nan.csv, line {}: ", row + 1);
            assert!(said.stderr.contains(&place), "row {row}: {said}");
        }
    }
}

/// Lines of the program that move, by their number in the file from 0.
fn moves(lines: &[String]) -> Vec<usize> {
    let is_move = |line: &String| line.starts_with('C') && line.contains(" X");
    (0..lines.len()).filter(|i| is_move(&lines[*i])).collect()
}

/// The program with one of its words changed: `Z1.7758595:0`, its position or its velocity.
fn word_changed(point: usize, axis: char, change: impl Fn(f64, f64) -> (f64, f64)) -> Vec<String> {
    let mut lines = lines_of("out/recipe.pmc");
    let line = moves(&lines)[point - 1];
    let words = lines[line].split(' ').map(|word| {
        let Some(numbers) = word.strip_prefix(axis) else {
            return word.to_owned();
        };
        let (p, v) = numbers.split_once(':').unwrap();
        let (p, v) = change(p.parse().unwrap(), v.parse().unwrap());
        format!("{axis}{p:.7}:{v:.7}")
    });
    lines[line] = words.collect::<Vec<_>>().join(" ");
    lines
}

#[test]
fn a_program_has_a_move_for_every_row() {
    let lines = lines_of("out/recipe.pmc");
    assert_eq!(moves(&lines).len(), table().len() - 1);
}

#[test]
fn a_spoiled_word_of_a_program_is_reported() {
    let (first, last) = cut();
    for point in [120, first, 800, 2000, 3000, last, last + 50] {
        let lines = word_changed(point, 'Z', |z, v| (z + 50e-6, v));
        told_at(
            &verify("z50.pmc", &lines),
            point,
            &["z_position", "z_motion"],
        );
        let lines = word_changed(point, 'C', |c, v| (c, 1.01 * v));
        told_at(&verify("vc.pmc", &lines), point, &["c_motion"]);
    }
    for point in [first + 20, 800, 2000, 3000] {
        let lines = word_changed(point, 'Z', |z, v| (z, 1.01 * v));
        told_at(&verify("vz.pmc", &lines), point, &["z_motion"]);
    }
}

/// A move gives its own duration, so the moves after it come earlier.
#[test]
fn moves_of_a_program_that_are_lost_or_swapped_exceed_the_tolerance_there() {
    let clean = lines_of("out/recipe.pmc");
    let (moves, rows) = (moves(&clean), table());
    for point in [800, 2000, 3000] {
        let mut lost = clean.clone();
        lost.remove(moves[point - 1]);
        let mut swapped = clean.clone();
        swapped.swap(moves[point - 1], moves[point]);
        for (name, lines) in [("lost.pmc", lost), ("swapped.pmc", swapped)] {
            let said = verify(name, &lines);
            if said.status == Some(4) {
                assert!(said.stderr.contains(", line "), "{said}");
                continue;
            }
            let verified = said.ends(1).json();
            assert_eq!(verified["within"]["interpolation"], false);
            let at = number(&verified, "/interpolation_error/at/c_deg");
            let c = value(&rows[point], C);
            assert!(
                (at - c).abs() <= 90.0,
                "{name}: at {at} deg, wrong at {c} deg"
            );
        }
    }
}

#[test]
fn a_word_of_a_program_that_is_no_number_is_refused_with_its_line() {
    let clean = lines_of("out/recipe.pmc");
    let moves = moves(&clean);
    for point in [1, 120, 2000, moves.len()] {
        let mut lines = clean.clone();
        let line = moves[point - 1];
        lines[line] = lines[line].replace(" Z", " ZNaN");
        let said = verify("nan.pmc", &lines).ends(4);
        let place = format!("nan.pmc, line {}: ", line + 1);
        assert!(said.stderr.contains(&place), "{said}");
    }
}
