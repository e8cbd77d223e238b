//! `[path] lead = true`: leads are held against the file's own numbers, and against a first touch that
//! this file calculates.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::Value;
use turnpath_core::{DEG, Scalar};

/// z = K ρ² sin 2θ.
const K: f64 = 0.08;
const NOSE: f64 = 1.0;
const RIM: f64 = 2.5;
/// The recipe's interpolation tolerance, mm.
const TOLERANCE: f64 = 1e-4;
/// Instants of a segment.
const INSTANTS: u32 = 41;

/// A row of `toolpath.csv`; angles in deg.
type Row = [f64; 8];
const SECTION: usize = 7;

fn lead(recipe: &str) -> String {
    changed(recipe, "lead = false", "lead = true")
}

fn rows(bench: &Bench) -> Vec<Row> {
    let text = bench.read("out/toolpath.csv");
    let lines = text.lines().skip(1);
    lines
        .map(|line| {
            let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            values.try_into().unwrap()
        })
        .collect()
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/summary.json")).unwrap()
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// A bench with the recipe's run in `out`.
#[track_caller]
fn made(recipe: &str, sets: &[&str]) -> Bench {
    let bench = Bench::with(recipe);
    let mut words = vec!["run", "recipe.toml", "-o", "out"];
    words.extend(sets.iter().flat_map(|set| ["--set", set]));
    bench.call(words).ends(0);
    bench
}

/// Z of a nose that is stopped by the saddle: where its height over the contact falls from rising
/// to falling, found by halving; of a point, the saddle itself.
fn first_touch(c_deg: f64, x: f64, nose: f64) -> f64 {
    let bend = 2.0 * K * Scalar::sin(2.0 * c_deg * DEG);
    let height = |s: f64| 0.5 * bend * s * s;
    if nose == 0.0 {
        return height(x);
    }
    let lift = |s: f64| (nose * nose - (s - x) * (s - x)).max(0.0).sqrt();
    let (mut low, mut high) = (x - nose, x + nose);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match bend * middle * lift(middle) > middle - x {
            true => low = middle,
            false => high = middle,
        }
    }
    height(low) + lift(low)
}

/// One axis between two rows: its cubic in the part of the segment.
struct AxisCubic {
    p: [f64; 2],
    m: [f64; 2],
    time: f64,
}

impl AxisCubic {
    fn new(from: &Row, to: &Row, axis: usize) -> Self {
        let time = to[0] - from[0];
        Self {
            p: [from[axis], to[axis]],
            m: [from[axis + 3] * time, to[axis + 3] * time],
            time,
        }
    }

    fn at(&self, s: f64) -> f64 {
        let [p0, p1] = self.p;
        let [m0, m1] = self.m;
        let (a, b) = (3.0 * (p1 - p0) - 2.0 * m0 - m1, m0 + m1 - 2.0 * (p1 - p0));
        p0 + s * (m0 + s * (a + s * b))
    }

    /// Accelerations at both ends, and what the digits of doubles leave of them.
    fn bends(&self) -> (f64, f64, f64) {
        let ([p0, p1], [m0, m1]) = (self.p, self.m);
        let per_time = 1.0 / (self.time * self.time);
        let (first, last) = (
            6.0 * (p1 - p0) - 4.0 * m0 - 2.0 * m1,
            2.0 * m0 + 4.0 * m1 - 6.0 * (p1 - p0),
        );
        let rounding = 60.0 * f64::EPSILON * p0.abs().max(1.0);
        (first * per_time, last * per_time, rounding * per_time)
    }
}

/// Velocity and acceleration do not jump in the leads and where they join the cut, and are zero at
/// the ends.
fn check_smooth(rows: &[Row]) {
    let end = rows.len() - 1;
    for axis in 1..=3 {
        let bends: Vec<_> = rows
            .windows(2)
            .map(|pair| AxisCubic::new(&pair[0], &pair[1], axis).bends())
            .collect();
        let largest = bends
            .iter()
            .fold(0.0f64, |most, b| most.max(b.0.abs()).max(b.1.abs()));
        assert_eq!((rows[0][axis + 3], rows[end][axis + 3]), (0.0, 0.0));
        let at_rest = [
            (bends[0].0, bends[0].2),
            (bends[end - 1].1, bends[end - 1].2),
        ];
        for (bend, rounding) in at_rest {
            assert!(
                bend.abs() <= 1e-9 * largest + rounding,
                "axis {axis}: {bend}"
            );
        }
        for k in 1..end {
            let cuts = |row: usize| rows[row][SECTION] == 1.0;
            if cuts(k - 1) && cuts(k) && cuts(k + 1) {
                continue;
            }
            let (before, after) = (bends[k - 1], bends[k]);
            let jump = (after.0 - before.1).abs();
            let bound = 1e-9 * largest + before.2 + after.2;
            assert!(jump <= bound, "axis {axis}, row {k}: {jump}, of {largest}");
        }
    }
}

/// Smallest played − first touch in the leads.
fn smallest_clearance(rows: &[Row], nose: f64) -> f64 {
    let mut smallest = f64::INFINITY;
    for pair in rows.windows(2) {
        if pair[0][SECTION] == 1.0 && pair[1][SECTION] == 1.0 {
            continue;
        }
        let [c, x, z] = [1, 2, 3].map(|axis| AxisCubic::new(&pair[0], &pair[1], axis));
        for i in 0..INSTANTS {
            let s = f64::from(i) / f64::from(INSTANTS - 1);
            let touch = first_touch(c.at(s), x.at(s), nose);
            smallest = smallest.min(z.at(s) - touch);
        }
    }
    smallest
}

/// Everything that a saddle's path with leads must keep, by its files alone.
#[track_caller]
fn check(bench: &Bench, nose: f64, clearance: f64) {
    let (rows, summary) = (rows(bench), summary(bench));
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    assert!(
        rows.windows(2)
            .all(|pair| pair[0][SECTION] <= pair[1][SECTION])
    );
    assert_eq!(rows[0][..2], [0.0, 0.0]);
    let count = |section: f64| rows.iter().filter(|row| row[SECTION] == section).count();
    assert!(count(0.0) > 0 && count(2.0) > 0);
    assert_eq!(number(&summary, "/control_points"), count(1.0) as f64);
    assert_eq!(number(&summary, "/rows"), rows.len() as f64);
    let leads = (count(0.0) + count(2.0)) as f64;
    assert_eq!(number(&summary, "/lead/control_points"), leads);
    let (first, last) = (rows[count(0.0)], rows[count(0.0) + count(1.0) - 1]);
    let turns = first[1] / 360.0;
    assert!((turns - turns.round()).abs() < 1e-12, "{turns}");
    assert_eq!(number(&summary, "/lead/turns_in"), turns.round());
    let end = rows[rows.len() - 1];
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
    close(number(&summary, "/lead/in_s"), first[0]);
    close(number(&summary, "/lead/out_s"), end[0] - last[0]);
    close(number(&summary, "/cutting_time_s"), last[0] - first[0]);

    check_smooth(&rows);
    let smallest = smallest_clearance(&rows, nose);
    assert!(smallest >= -0.6 * TOLERANCE, "{smallest}");
    let reported = 1e-6 * number(&summary, "/lead/smallest_clearance_nm");
    assert!(
        (reported - smallest).abs() < 0.02 * TOLERANCE,
        "{reported} {smallest}"
    );
    assert_eq!(summary["within"]["lead"], true);

    // The highest place, over X up to a contact at the rim.
    let mut highest = f64::NEG_INFINITY;
    for degree in 0..360 {
        for step in 0..=300 {
            let x = (RIM + 0.5) * f64::from(step) / 300.0;
            highest = highest.max(first_touch(f64::from(degree), x.min(RIM), nose));
        }
    }
    for rest in [rows[0], end] {
        let above = rest[3] - highest;
        assert!(
            above > clearance - 1e-4 && above < clearance + 0.7,
            "{above}"
        );
    }
    close(number(&summary, "/lead/rest_clearance_mm"), clearance);

    let verified = bench.line("verify recipe.toml out/toolpath.csv --format json");
    let verified = verified.ends(0).json();
    assert_eq!(verified["within"]["lead"], true);
    for pointer in [
        "/lead/smallest_clearance_nm",
        "/interpolation_error/max_nm",
        "/residual/max_nm",
    ] {
        let (one, other) = (number(&summary, pointer), number(&verified, pointer));
        assert!((one - other).abs() <= 1e-6 * one.abs() + 1e-4, "{pointer}");
    }
}

#[test]
fn every_compensator_in_both_directions_with_and_without_a_hole() {
    for (compensator, nose) in [("z-direction", NOSE), ("normal", NOSE), ("none", 0.0)] {
        let recipe = with_table(
            &lead(SADDLE),
            "compensator",
            &format!("use = \"{compensator}\""),
        );
        for sets in [
            &["path.direction=inward"][..],
            &["path.direction=outward"],
            &["path.direction=inward", "part.inner=1mm"],
            &["path.direction=outward", "part.inner=1mm"],
        ] {
            let recipe = sets.iter().fold(recipe.clone(), |recipe, set| {
                let value = set.split_once('=').unwrap().1;
                match set.starts_with("part") {
                    true => changed(&recipe, "[part]", &format!("[part]\ninner = \"{value}\"")),
                    false => changed(
                        &recipe,
                        "[path]",
                        &format!("[path]\ndirection = \"{value}\""),
                    ),
                }
            });
            check(&made(&recipe, &[]), nose, 1.0);
        }
    }
}

#[test]
fn every_solver_of_cubics_and_a_clearance_of_ones_own() {
    for solver in [
        "use = \"analytic\"",
        "use = \"three-point\"",
        "use = \"area\"\nc = 0.6666666666666666",
        "use = \"triangle-rotary\"\nends = \"natural\"",
        "use = \"triangle-rotary\"\nends = \"not-a-knot\"",
    ] {
        let recipe = with_table(&lead(SADDLE), "velocity", solver);
        let recipe = changed(&recipe, "[path]", "[path]\nclearance = \"50 um\"");
        check(&made(&recipe, &[]), NOSE, 0.05);
    }
}

#[test]
fn a_tolerance_of_a_nanometre_makes_the_steps_near_the_part_finer() {
    let recipe = changed(
        &lead(SADDLE),
        "interpolation = \"100 nm\"",
        "interpolation = \"1 nm\"",
    );
    let bench = made(&recipe, &[]);
    let smallest = smallest_clearance(&rows(&bench), NOSE);
    assert!(smallest >= -1e-6, "{smallest}");
    let coarse = number(&summary(&made(&lead(SADDLE), &[])), "/lead/control_points");
    assert!(number(&summary(&bench), "/lead/control_points") > coarse);
}

#[test]
fn straight_lines_have_leads_that_clear_the_part() {
    let recipe = with_table(&lead(SADDLE), "velocity", "use = \"linear\"");
    let bench = made(&recipe, &[]);
    let rows = rows(&bench);
    let mut smallest = f64::INFINITY;
    for pair in rows.windows(2) {
        if pair[0][SECTION] == 1.0 && pair[1][SECTION] == 1.0 {
            continue;
        }
        for i in 0..INSTANTS {
            let s = f64::from(i) / f64::from(INSTANTS - 1);
            let at = |axis: usize| pair[0][axis] + s * (pair[1][axis] - pair[0][axis]);
            smallest = smallest.min(at(3) - first_touch(at(1), at(2), NOSE));
        }
    }
    assert!(smallest >= -0.6 * TOLERANCE, "{smallest}");
    bench.line("verify recipe.toml out/toolpath.csv").ends(0);
}

#[test]
fn one_two_and_three_threads_give_the_same_bytes() {
    let recipe = lead(SADDLE);
    let with = |threads: &str| {
        let bench = Bench::with(&recipe);
        let words =
            format!("run recipe.toml -o out --threads {threads} --set output.posts=[\"pmac-pvt\"]");
        bench.line(&words).ends(0);
        ["out/toolpath.csv", "out/recipe.pmc"].map(|file| bench.read(file))
    };
    let one = with("1");
    assert!(one == with("2") && one == with("3"));
}

#[test]
fn programs_carry_the_leads_and_read_back_with_all_points() {
    for settings in [
        "positioning = \"absolute\"",
        "positioning = \"incremental\"",
        "c_wrap = \"0-360\"",
    ] {
        let recipe = format!(
            "{}\n[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n{settings}\n",
            lead(SADDLE)
        );
        let bench = made(&recipe, &[]);
        let summary = summary(&bench);
        assert_eq!(summary["programs"][0]["within_lead"], true);
        let program = bench.read("out/recipe.pmc");
        let (rows, count) = (rows(&bench), number(&summary, "/rows"));
        assert_eq!(rows.len() as f64, count);
        assert!(program.contains(&format!("; -- end of path: {count} points --\n")));
        assert!(program.contains(&format!("post pmac-pvt: {count} points")));
        assert!(program.contains("; the path begins and ends at rest\n"));
        let marks: Vec<&str> = program.lines().filter(|l| l.starts_with("; --")).collect();
        assert_eq!(
            marks[..5],
            [
                "; -- approach --",
                "; -- lead-in --",
                "; -- cutting --",
                "; -- lead-out --",
                "; -- retreat --"
            ]
        );
        // The first move goes to rest.
        let first = program
            .lines()
            .find(|line| line.starts_with("C0:"))
            .unwrap();
        let at_rest = first.split(' ').all(|word| word.ends_with(":0"));
        assert!(at_rest, "{first}");
        let verified = bench.line("verify recipe.toml out/recipe.pmc --format json");
        let verified = verified.ends(0).json();
        assert_eq!(verified["rows"], summary["rows"]);
        assert_eq!(verified["control_points"], summary["control_points"]);
        assert_eq!(verified["within"]["lead"], true);
        let last = &rows[rows.len() - 1];
        let steps = last[0] * 4_096_000.0;
        assert!((steps - steps.round()).abs() < 1e-4);
    }
}

/// `verify` of the saddle's path with one value of the rows of a section changed.
fn spoiled(change: impl Fn(&mut Row)) -> Value {
    let bench = made(&lead(SADDLE), &[]);
    let mut text = bench
        .read("out/toolpath.csv")
        .lines()
        .next()
        .unwrap()
        .to_owned()
        + "\n";
    for mut row in rows(&bench) {
        change(&mut row);
        let (section, values) = (row[SECTION], &row[..SECTION]);
        for value in values {
            text += &format!("{value},");
        }
        text += &format!("{section}\n");
    }
    bench.write("spoiled.csv", text);
    let said = bench.line("verify recipe.toml spoiled.csv --format json");
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let holds = said.status == Some(0);
    let verified = said.json();
    assert_eq!(verified["within"]["lead"], holds);
    assert_eq!(verified["within"]["interpolation"], true);
    verified
}

#[test]
fn a_lead_that_plunges_or_jumps_is_found_in_a_file() {
    let good = spoiled(|_| ());
    let jump = "/lead/acceleration_step/z_mm_per_s2";
    assert!(number(&good, jump) < 1e-4, "{good}");
    for section in [0.0, 2.0] {
        let low = spoiled(|row| {
            if row[SECTION] == section {
                row[3] -= 0.01;
            }
        });
        assert_eq!(low["within"]["lead"], false);
        assert!(
            number(&low, "/lead/smallest_clearance_nm") < -5000.0,
            "{low}"
        );
        let high = spoiled(|row| {
            if row[SECTION] == section {
                row[3] += 0.01;
            }
        });
        assert_eq!(high["within"]["lead"], true);
        assert!(number(&high, jump) > 1.0, "{high}");
    }
    let bench = made(&lead(SADDLE), &[]);
    let text = bench.read("out/toolpath.csv");
    // Straight down, without the lead.
    let lines: Vec<&str> = text.lines().collect();
    let cut: Vec<&str> = lines
        .iter()
        .copied()
        .filter(|l| l.ends_with(",1"))
        .collect();
    bench.write("bare.csv", format!("{}\n{}\n", lines[0], cut.join("\n")));
    let bare = bench
        .line("verify recipe.toml bare.csv --format json")
        .ends(1)
        .json();
    assert_eq!(bare["lead"], Value::Null);
    assert_eq!(bare["within"]["lead"], Value::Null);
    assert_eq!(bare["within"]["whole"], false);
}

#[test]
fn the_text_reports_the_leads() {
    let bench = Bench::with(&lead(SADDLE));
    let said = bench.line("run recipe.toml -o out").ends(0);
    let line = said
        .stdout
        .lines()
        .find(|line| line.starts_with("  lead "))
        .unwrap();
    assert!(
        line.ends_with("clears the part by 1.000 mm at rest"),
        "{line}"
    );
    let said = bench.line("verify recipe.toml out/toolpath.csv").ends(0);
    let line = said
        .stdout
        .lines()
        .find(|line| line.starts_with("  lead "))
        .unwrap();
    let digs = line.ends_with("into the wanted surface at most; holds");
    assert!(
        digs || line.ends_with("above the wanted surface; holds")
            || line.ends_with("wanted surface and no deeper; holds"),
        "{line}"
    );
}

#[test]
fn without_a_lead_the_summary_has_null() {
    let summary = summary(&made(SADDLE, &[]));
    assert_eq!(summary["lead"], Value::Null);
    assert_eq!(summary["within"]["lead"], Value::Null);
}

/// The speed that the summary reports, less a hundredth, gives a path.
#[test]
fn just_below_the_highest_spindle_speed_the_lead_keeps_the_limits_too() {
    let recipe = std::fs::read_to_string(ARRAY).unwrap();
    let limited = format!("{recipe}\n[machine]\npreset = \"generic-sts\"\n");
    let highest = number(&summary(&made(&limited, &[])), "/highest_spindle/speed_rpm");
    for part in [0.9, 0.99, 1.0] {
        let speed = format!("spindle.speed=\"{} rpm\"", part * highest);
        let bench = made(&limited, &[&speed]);
        let (rows, found) = (rows(&bench), summary(&bench));
        assert_eq!(found["within"]["machine"], true);
        // By the file's own numbers: accelerations of Z at both ends of each segment.
        let played = rows
            .windows(2)
            .map(|pair| AxisCubic::new(&pair[0], &pair[1], 3).bends());
        let largest = played.fold(0.0f64, |most, b| most.max(b.0.abs()).max(b.1.abs()));
        assert!(largest <= 500.5, "{largest} mm/s² at {part}");
    }
}

const ARRAY: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../docs/recipes/sinusoidal-array-10mm.toml"
);

#[test]
fn a_lead_that_no_time_makes_gentle_enough_is_written_and_reported() {
    // A part so flat that the cut itself asks for nothing.
    let recipe = changed(&lead(SADDLE), "k = \"0.08 /mm\"", "k = \"1e-9 /mm\"");
    let recipe = format!("{recipe}\n[machine]\nz_velocity = \"0.1 um/s\"\n");
    let bench = Bench::with(&recipe);
    let said = bench.line("run recipe.toml -o out").ends(1);
    let (found, rows) = (summary(&bench), rows(&bench));
    assert_eq!(found["within"]["machine"], false);
    assert_eq!(found["within"]["interpolation"], true);
    assert_eq!(number(&found, "/rows"), rows.len() as f64);
    let reported = said.stdout.lines().find(|line| line.contains("EXCEEDED"));
    let reported = reported.unwrap_or_else(|| panic!("{said}"));
    assert!(
        reported.contains("lead Z velocity") && reported.contains("X = "),
        "{reported}"
    );
    check_smooth(&rows);
}

/// A law that is in full motion at the axis goes on beyond it before or after the cut.
#[test]
fn a_lead_that_crosses_the_axis_is_reported() {
    let bench = Bench::with(&lead(SADDLE));
    for (direction, overrun, crosses) in [
        ("inward", "none", true),
        ("outward", "none", true),
        ("inward", "contact", false),
        ("outward", "contact", false),
    ] {
        let said = bench.line(&format!(
            "run recipe.toml -o out --set path.overrun={overrun} --set path.direction={direction}"
        ));
        let rows = rows(&bench);
        let lowest = rows
            .iter()
            .filter(|row| row[SECTION] != 1.0)
            .map(|row| row[2])
            .fold(0.0, f64::min);
        let reported = number(&summary(&bench), "/lead/axis_crossing_um");
        assert!(
            (reported + 1e3 * lowest).abs() < 0.01,
            "{reported} {lowest}"
        );
        let lines = said.stdout.lines();
        let warned = lines.filter(|line| line.contains("lead warning")).count();
        assert_eq!((warned == 1, reported > 1.0), (crosses, crosses), "{said}");
    }
}

#[test]
fn the_velocity_of_an_axis_at_rest_is_exactly_zero() {
    let bench = made(&lead(SADDLE), &[]);
    let rows = rows(&bench);
    let resting = |axis: usize| {
        let all = rows.windows(3).filter(move |three| {
            three[0][axis] == three[1][axis] && three[1][axis] == three[2][axis]
        });
        all.map(move |three| three[1][axis + 3])
    };
    for axis in [2, 3] {
        assert!(resting(axis).count() > 20);
        assert!(resting(axis).all(|v| v == 0.0 || v.abs() > 1e-16));
    }
}
