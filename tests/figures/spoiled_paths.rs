//! Paths that were spoiled by hand, in the cut, near its ends and on leads: `turnpath verify` reports
//! each with its place, whether or not a tolerance is exceeded.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::OnceLock;

use crate::support::bench::{Answer, Bench};
use serde_json::Value;

const AST_5: &str = include_str!("../../docs/recipes/astigmatic-5mm.toml");
const CONIC: &str = include_str!("../../docs/recipes/conic-50mm.toml");

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

/// The only anomaly is this row, and `what` is the column in which it differs, or its kind.
#[track_caller]
fn told_at(said: &Answer, row: usize, what: &str) {
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let verified = said.json();
    let anomalies = &verified["anomalies"];
    assert_eq!(anomalies["count"], 1, "row {row}: {anomalies}");
    let place = &anomalies["places"][0];
    assert_eq!(place["point"], row, "{place}");
    let found = match place["kind"].as_str().unwrap() {
        "row_differs" => place["columns"][0].as_str().unwrap(),
        other => other,
    };
    assert_eq!(found, what, "row {row}: {place}");
    assert_eq!(anomalies["compared_with"], "recipe");
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

/// The anomalies of a file are these rows, each in this column alone.
#[track_caller]
fn told_at_all(said: &Answer, rows: &[usize], column: &str) {
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let anomalies = &said.json()["anomalies"];
    let places = anomalies["places"].as_array().unwrap();
    let mut points: Vec<u64> = places
        .iter()
        .map(|p| p["point"].as_u64().unwrap())
        .collect();
    points.sort_unstable();
    let mut rows: Vec<u64> = rows.iter().map(|row| *row as u64).collect();
    rows.sort_unstable();
    assert_eq!(points, rows, "{anomalies}");
    for place in places {
        assert_eq!(place["columns"], serde_json::json!([column]), "{place}");
    }
}

/// The table with one column changed in many rows.
fn edited_at_all(rows: &[usize], column: usize, change: impl Fn(f64) -> f64) -> Vec<String> {
    let mut lines = table();
    for row in rows {
        lines[*row] = edited(*row, column, &change)[*row].clone();
    }
    lines
}

#[test]
fn points_that_are_moved_by_50_nm_are_told() {
    let said = verify("z50.csv", &edited_at_all(&rows(), Z, |z| z + 50e-6));
    told_at_all(&said, &rows(), "z");
    let error = number(&said.json(), "/control_point_error/max_nm");
    assert!((error - 50.0).abs() < 0.01, "{error} nm");
    let said = verify("x50.csv", &edited_at_all(&rows(), X, |x| x + 50e-6));
    told_at_all(&said, &rows(), "x");
}

#[test]
fn velocities_that_are_wrong_by_a_hundredth_are_told_with_their_axis() {
    for (column, name) in [(VC, "vc"), (VX, "vx"), (VZ, "vz")] {
        let mut moving = rows();
        moving.retain(|row| value(&table()[*row], column) != 0.0);
        assert!(moving.len() >= 12, "{name}: {moving:?}");
        let said = verify("v.csv", &edited_at_all(&moving, column, |v| 1.01 * v));
        told_at_all(&said, &moving, name);
    }
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
fn rows_that_are_lost_are_told() {
    let (first, last) = cut();
    let lost = [
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
    ];
    let mut lines = table();
    for row in lost.iter().rev() {
        lines.remove(*row);
    }
    let said = verify("lost.csv", &lines);
    let anomalies = &said.json()["anomalies"];
    let places = anomalies["places"].as_array().unwrap();
    assert!(
        places.iter().all(|place| place["kind"] == "row_lost"),
        "{anomalies}"
    );
    let mut points: Vec<u64> = places
        .iter()
        .map(|p| p["point"].as_u64().unwrap())
        .collect();
    points.sort_unstable();
    // A row has the number that it would have in the file, where those before it are lost too.
    let numbers = lost
        .iter()
        .enumerate()
        .map(|(before, row)| (row - before) as u64);
    assert_eq!(points, numbers.collect::<Vec<_>>(), "{anomalies}");
}

#[test]
fn the_text_reports_an_anomaly_and_the_tolerance_decides() {
    made().write("told.csv", edited(2000, Z, |z| z + 50e-6).join("\n") + "\n");
    let said = made().line("verify recipe.toml told.csv").ends(0);
    for line in [
        "  anomalies       1 row is not as the recipe gives it, a warning\n",
        "                  point 2,000, C = ",
        "                    wrong: Z; the played path moves by 50.00 nm\n",
    ] {
        assert!(said.stdout.contains(line), "{said}");
    }
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
        told_at(&verify("z50.pmc", &lines), point, "z");
        let lines = word_changed(point, 'C', |c, v| (c, 1.01 * v));
        told_at(&verify("vc.pmc", &lines), point, "vc");
    }
    for point in [first + 20, 800, 2000, 3000] {
        let lines = word_changed(point, 'Z', |z, v| (z, 1.01 * v));
        told_at(&verify("vz.pmc", &lines), point, "vz");
    }
}

/// Minutes for seconds, say: the same places at ten times the speed.
#[test]
fn a_path_that_turns_faster_than_its_spindle_exceeds_it() {
    let at_speed = |factor: f64| {
        let mut lines = table();
        for line in &mut lines[1..] {
            let mut values: Vec<String> = line.split(',').map(String::from).collect();
            for column in [VC, VX, VZ] {
                values[column] = (factor * value(line, column)).to_string();
            }
            values[0] = (value(line, 0) / factor).to_string();
            *line = values.join(",");
        }
        verify("faster.csv", &lines)
    };
    let said = at_speed(10.0).ends(1).json();
    assert_eq!(said["within"]["spindle"], false);
    assert_eq!(said["within"]["interpolation"], true);
    assert!(
        number(&said, "/cutting_speed/spindle_most_rpm")
            > 9.0 * number(&said, "/spindle_limit_rpm")
    );
    for factor in [0.1, 1.0] {
        assert_eq!(at_speed(factor).ends(0).json()["within"]["spindle"], true);
    }
}

/// In such a program a distance that is wrong or lost moves all points behind it.
#[test]
fn a_distance_that_is_wrong_or_lost_is_one_row() {
    is_one_row(AST_5, "", [300, 3000]);
}

/// On a conic neighbouring distances differ in their last digits alone.
#[test]
fn a_distance_that_is_lost_among_others_like_it_is_one_row() {
    is_one_row(CONIC, "--set part.aperture=20mm", [1000, 5000]);
}

fn is_one_row(recipe: &str, own: &str, points: [usize; 2]) {
    let sets = format!(
        "{own} --set output.posts=[\"pmac-pvt\",\"automation1-pvt\"] \
         --set output.pmac-pvt.positioning=incremental --set output.automation1-pvt.positioning=incremental"
    );
    let bench = Bench::with(recipe);
    bench
        .line(&format!("run recipe.toml -o out --no-report {sets}"))
        .ends(0);
    let told = |name: &str, lines: &[String], kind: &str| {
        bench.write(name, lines.join("\n") + "\n");
        let said = bench.line(&format!("verify recipe.toml {name} --format json {sets}"));
        let anomalies = &said.json()["anomalies"];
        assert_eq!(anomalies["compared_with"], "recipe", "{name}: {said}");
        assert_eq!(anomalies["count"], 1, "{name}: {said}");
        assert_eq!(anomalies["places"][0]["kind"], kind, "{name}: {said}");
        anomalies["places"][0]["point"].as_u64().unwrap()
    };
    for (extension, is_move) in [("pmc", "C"), ("ascript", "MovePvt(")] {
        let name = format!("spoiled.{extension}");
        let program = bench.read(format!("out/recipe.{extension}"));
        let clean: Vec<String> = program.lines().map(String::from).collect();
        let moves: Vec<usize> = (0..clean.len())
            .filter(|line| clean[*line].starts_with(is_move) && clean[*line].contains('X'))
            .collect();
        for point in points {
            let line = moves[point - 1];
            let mut wrong = clean.clone();
            // X goes by less than a micrometre.
            let digit = wrong[line].find("0.000").unwrap() + "0.000".len();
            let other = match &wrong[line][digit..=digit] {
                "5" => "1",
                _ => "5",
            };
            wrong[line].replace_range(digit..=digit, other);
            assert_eq!(told(&name, &wrong, "row_differs"), point as u64);

            let mut lost = clean.clone();
            lost.remove(line);
            let end = format!("{} points", moves.len());
            let mut backwards = lost.iter_mut().rev();
            let mark = backwards.find(|line| line.contains(&end)).unwrap();
            *mark = mark.replace(&end, &format!("{} points", moves.len() - 1));
            assert_eq!(told(&name, &lost, "row_lost"), point as u64);
        }
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

/// Every Z is lower by 0.03 nm, as if another program had made the path, and one point is moved.
#[test]
fn a_file_of_another_maker_is_said_to_be_one_and_compared_with_its_neighbours() {
    let lines = table();
    let lowered = |(row, line): (usize, &String)| {
        let mut values: Vec<String> = line.split(',').map(String::from).collect();
        if row > 0 {
            let off = if row == 2000 { 50e-6 } else { 0.0 };
            values[Z] = (value(line, Z) - 3e-8 + off).to_string();
        }
        values.join(",")
    };
    let lines: Vec<String> = lines.iter().enumerate().map(lowered).collect();
    let said = verify("other.csv", &lines).ends(0);
    let anomalies = &said.json()["anomalies"];
    assert_eq!(anomalies["compared_with"], "neighbours", "{anomalies}");
    let reason = anomalies["not_compared_because"].as_str().unwrap();
    assert!(reason.contains("another maker's"), "{reason}");
    assert_eq!(anomalies["count"], 1, "{anomalies}");
    let place = &anomalies["places"][0];
    assert_eq!(
        (&place["point"], &place["kind"]),
        (&2000.into(), &"z_position".into())
    );
    let said = made().line("verify recipe.toml other.csv").ends(0);
    assert!(
        said.stdout
            .contains("1 place stands out, which may be honest"),
        "{said}"
    );
}

/// Figures and verdicts need no strategy but those of the surface, the compensator and the solver.
#[test]
fn a_path_that_cannot_be_made_again_is_measured_all_the_same() {
    let call = "verify recipe.toml out/toolpath.csv --format json --set sampler.use=none-such";
    let verified = made().line(call).ends(0).json();
    let anomalies = &verified["anomalies"];
    assert_eq!(anomalies["compared_with"], "neighbours", "{anomalies}");
    let reason = anomalies["not_compared_because"].as_str().unwrap();
    assert!(reason.contains("none-such"), "{reason}");
    let whole = made()
        .line("verify recipe.toml out/toolpath.csv --format json")
        .ends(0)
        .json();
    for key in ["interpolation_error", "residual", "surface_error", "within"] {
        assert_eq!(verified[key], whole[key], "{key}");
    }
}

/// Places that are reported come worst first, however many they are.
#[test]
fn the_worst_of_many_faults_comes_first() {
    let mut lines = table();
    let rows = [200, 600, 1000, 1400, 1800, 2200, 2600, 3000];
    for (k, row) in rows.into_iter().enumerate() {
        let off = 1e-6 * (10.0 + ((k * 5) % 8) as f64);
        let mut values: Vec<String> = lines[row].split(',').map(String::from).collect();
        values[Z] = (value(&lines[row], Z) + off).to_string();
        lines[row] = values.join(",");
    }
    let verified = verify("many.csv", &lines).json();
    let places = verified["anomalies"]["places"].as_array().unwrap();
    let worths: Vec<f64> = places
        .iter()
        .map(|place| number(place, "/by_nm").round())
        .collect();
    assert_eq!(worths, [17.0, 16.0, 15.0, 14.0, 13.0, 12.0, 11.0, 10.0]);
    made().write("many.csv", lines.join("\n") + "\n");
    let said = made().line("verify recipe.toml many.csv");
    let first = said.stdout.find("moves by 17.00 nm").unwrap();
    assert!(
        first < said.stdout.find("moves by 16.00 nm").unwrap(),
        "{said}"
    );
    assert!(said.stdout.contains("and 3 places more\n"), "{said}");
}
