//! Limits of the machine on programs: their last digits make jerks that the path has not.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fmt::Write as _;

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};

/// Limits that a path holds by less than a thousandth.
fn limits_above(summary: &Value) -> String {
    let mut table = String::from("[machine]\n");
    for axis in ["x", "z"] {
        for (what, unit) in [
            ("velocity", "mm_per_s"),
            ("acceleration", "mm_per_s2"),
            ("jerk", "mm_per_s3"),
        ] {
            let most = &summary["axes"][axis][format!("max_{what}_{unit}")];
            let (most, unit) = (most.as_f64().unwrap(), unit.replace("_per_", "/"));
            let unit = unit.replace("s2", "s^2").replace("s3", "s^3");
            writeln!(table, "{axis}_{what} = \"{:.9} {unit}\"", 1.0005 * most).unwrap();
        }
    }
    table
}

/// A saddle with these posts in `out`, whose path just holds the limits of its machine.
fn made(posts: &str) -> Bench {
    let recipe = with_table(SADDLE, "feed", "use = \"atpg\"");
    let recipe = format!("{recipe}\n[output]\nposts = [{posts}]\n");
    let bench = Bench::with(&recipe);
    bench.line("run recipe.toml -o free").ends(0);
    let limits = limits_above(&serde_json::from_str(&bench.read("free/summary.json")).unwrap());
    bench.write("recipe.toml", format!("{recipe}\n{limits}"));
    bench.line("run recipe.toml -o out").ends(0);
    bench
}

fn limit<'a>(report: &'a Value, name: &str) -> &'a Value {
    let limits = report["machine"]["limits"].as_array().unwrap();
    let limit = limits.iter().find(|limit| limit["limit"] == name);
    limit.unwrap()
}

#[test]
fn programs_hold_the_limits_of_their_path_whatever_their_last_digits_make() {
    let bench = made(r#""pmac-pvt", "power-pmac-pvt", "automation1-pvt", "beckhoff-g93""#);
    for (program, name, unit) in [
        ("recipe.pmc", "x_jerk", "mm_per_s3"),
        ("recipe.ppmc", "x_jerk", "mm_per_s3"),
        ("recipe.ascript", "x_jerk", "mm_per_s3"),
        ("recipe.cnc", "x_acceleration", "mm_per_s2"),
    ] {
        let said = bench.line(&format!("verify recipe.toml out/{program} --format json"));
        let report = said.ends(0).json();
        assert_eq!(report["within"]["machine"], true, "{program}");
        let of = |key: &str| {
            let amount = &limit(&report, name)[format!("{key}_{unit}")];
            amount.as_f64().unwrap()
        };
        let [certain, most, measured] = ["certain", "limit", "measured"].map(of);
        assert!(
            certain < most && most < measured,
            "{program}: {certain} {most} {measured}"
        );
    }
    let said = bench.line("verify recipe.toml out/recipe.pmc").ends(0);
    assert!(said.stdout.contains("with rounding"), "{said}");
    // All digits of a double are certain, but for last bits.
    let said = bench.line("verify recipe.toml out/toolpath.csv --format json");
    let report = said.ends(0).json();
    let jerk = limit(&report, "x_jerk");
    let measured = jerk["measured_mm_per_s3"].as_f64().unwrap();
    let certain = jerk["certain_mm_per_s3"].as_f64().unwrap_or(measured);
    assert!((0.99 * measured..=measured).contains(&certain), "{jerk}");
}

/// The saddle's program with X of one row moved by a nanometre. The row of number 500 is at 12.5 turns.
fn moved_by_a_nanometre(program: &str) -> String {
    let rows = program.lines().filter(|line| line.starts_with('C'));
    let row = rows.clone().nth(500).unwrap();
    let (before, x) = row.split_once(" X").unwrap();
    let (x, after) = x.split_once(':').unwrap();
    let moved = x.parse::<f64>().unwrap() + 1e-6;
    program.replace(row, &format!("{before} X{moved:.7}:{after}"))
}

#[test]
fn a_program_with_a_row_that_is_moved_exceeds_the_limits_at_its_place() {
    let bench = made(r#""pmac-pvt""#);
    bench.line("verify recipe.toml out/recipe.pmc").ends(0);
    bench.write(
        "spoiled.pmc",
        moved_by_a_nanometre(&bench.read("out/recipe.pmc")),
    );
    let said = bench.line("verify recipe.toml spoiled.pmc").ends(1);
    let line = said
        .stdout
        .lines()
        .find(|line| line.contains("X jerk"))
        .unwrap();
    assert!(line.contains("EXCEEDED"), "{said}");
    let (_, c) = line.split_once("at C = ").unwrap();
    let c: f64 = c.split_once(" deg").unwrap().0.parse().unwrap();
    assert!((c - 4500.0).abs() < 10.0, "{line}");
    // Who says that the program has five decimals is not told that it holds.
    let coarse = "--set output.pmac-pvt.position_decimals=5";
    let said = bench.line(&format!("verify recipe.toml spoiled.pmc {coarse}"));
    assert!(said.ends(1).stdout.contains("X jerk"));
}

/// Turbo PMAC holds a C within a turn with 35 bits, after a hundred turns as after one.
#[test]
fn a_row_that_is_turned_exceeds_the_limit_of_c_on_any_turn() {
    let recipe = with_table(SADDLE, "feed", "use = \"atpg\"");
    let settings = "[output.pmac-pvt]\nc_wrap = \"0-360\"\n\n[machine]\nc_jerk = \"10 rad/s^3\"";
    let bench = Bench::with(&format!(
        "{recipe}\n[output]\nposts = [\"pmac-pvt\"]\n\n{settings}\n"
    ));
    bench.line("run recipe.toml -o out").ends(0);
    bench.line("verify recipe.toml out/recipe.pmc").ends(0);
    let program = bench.read("out/recipe.pmc");
    let rows = program.lines().filter(|line| line.starts_with('C'));
    let rows: Vec<&str> = rows.collect();
    for number in [100, 3900] {
        let (c, after) = rows[number].split_once(':').unwrap();
        let turned = c[1..].parse::<f64>().unwrap() + 2e-5;
        let spoiled: Vec<String> = program
            .lines()
            .map(|line| match std::ptr::eq(line, rows[number]) {
                true => format!("C{turned:.7}:{after}"),
                false => line.to_owned(),
            })
            .collect();
        bench.write("spoiled.pmc", spoiled.join("\n") + "\n");
        let said = bench.line("verify recipe.toml spoiled.pmc").ends(1);
        let line = said
            .stdout
            .lines()
            .find(|line| line.contains("C jerk"))
            .unwrap();
        assert!(line.contains("EXCEEDED"), "{number}: {said}");
    }
}

/// This sampler leaves a segment of one and a half microseconds before whole turns, on which the last bits of C make
/// a jerk.
#[test]
fn last_bits_of_c_exceed_no_limit() {
    let recipe = with_table(SADDLE, "sampler", "use = \"fft-adaptive\"");
    let recipe = changed(&recipe, "k = \"0.08 /mm\"", "k = \"0.01 /mm\"");
    let recipe = changed(&recipe, "aperture = \"5 mm\"", "aperture = \"6 mm\"");
    let recipe = changed(
        &recipe,
        "interpolation = \"100 nm\"",
        "interpolation = \"20 nm\"",
    );
    let recipe = changed(
        &recipe,
        "nose_radius = \"1 mm\"",
        "nose_radius = \"0.5 mm\"",
    );
    let recipe = changed(&recipe, "residual = \"100 nm\"", "residual = \"5 nm\"");
    let recipe = changed(&recipe, "overrun = \"none\"\n", "");
    let bench = Bench::with(&format!("{recipe}\n[machine]\nc_jerk = \"1000 rad/s^3\"\n"));
    bench.line("run recipe.toml -o out").ends(0);
    let said = bench
        .line("verify recipe.toml out/toolpath.csv --format json")
        .ends(0);
    let report = said.json();
    let measured = limit(&report, "c_jerk")["measured_deg_per_s3"].as_f64();
    assert!(measured.is_some_and(|jerk| jerk > 1e5), "{measured:?}");
    let highest = report["highest_spindle"]["speed_rpm"].as_f64();
    assert!(highest.is_some_and(|speed| speed > 1e4), "{highest:?}");
}
