//! The post `pmac-pvt`: programs are written, read back, measured, and refused.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::repository;
use serde_json::Value;
use tempfile::TempDir;

/// The largest difference between the errors of a program and of toolpath.csv, nm: the cost of 7
/// decimals.
const COST_NM: f64 = 0.3;
const POSTS: &str = "output.posts=[\"pmac-pvt\"]";
/// Equal steps on equal turns over the aperture alone: the expected figures of AST-5 were calculated
/// for these.
const EQUAL: [&str; 4] = [
    "path.overrun=none",
    "path.lead=false",
    "feed={use=\"constant\"}",
    "sampler={use=\"equal-angle\",step=\"9 deg\"}",
];

fn astigmatic() -> PathBuf {
    repository().join("docs/recipes/astigmatic-5mm.toml")
}

/// The program called with a command, a recipe, and `--set` for each of `sets`.
fn call(command: &str, recipe: &Path, rest: &[&str], sets: &[&str]) -> Output {
    let mut call = Command::new(env!("CARGO_BIN_EXE_turnpath"));
    call.arg(command).arg(recipe).args(rest);
    let equal = EQUAL.iter().filter(|_| recipe == astigmatic());
    for set in equal.chain(sets) {
        call.args(["--set", set]);
    }
    call.output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A run with the post, in a folder of its own.
struct Run {
    folder: TempDir,
    output: Output,
}

impl Run {
    fn of(recipe: &Path, sets: &[&str]) -> Self {
        Self::with(recipe, sets, &[])
    }

    fn with(recipe: &Path, sets: &[&str], rest: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let rest = [&["-o", out.to_str().unwrap()], rest].concat();
        let output = call("run", recipe, &rest, &[&[POSTS], sets].concat());
        Self { folder, output }
    }

    #[track_caller]
    fn ends(self, status: i32) -> Self {
        assert_eq!(
            self.output.status.code(),
            Some(status),
            "{}",
            stderr(&self.output)
        );
        self
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join("out").join(file)
    }

    fn read(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap()
    }

    fn summary(&self) -> Value {
        serde_json::from_str(&self.read("summary.json")).unwrap()
    }
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// The errors of toolpath.csv and of the program, nm.
fn errors(summary: &Value) -> (f64, f64) {
    (
        number(summary, "/interpolation_error/max_nm"),
        number(summary, "/programs/0/interpolation_error_nm"),
    )
}

#[track_caller]
fn costs_little(summary: &Value) {
    let (path, program) = errors(summary);
    assert!((path - program).abs() <= COST_NM, "{path} {program}");
}

/// The report of `verify` on a program.
fn verified(recipe: &Path, program: &Path, sets: &[&str]) -> Value {
    let rest = [program.to_str().unwrap(), "--format", "json"];
    let output = call("verify", recipe, &rest, sets);
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn the_programs_error_is_that_of_the_path_and_verify_finds_the_same() {
    let run = Run::of(&astigmatic(), &[]).ends(0);
    let summary = run.summary();
    costs_little(&summary);
    assert_eq!(summary["programs"][0]["file"], "astigmatic-5mm.pmc");
    assert_eq!(summary["programs"][0]["post"], "pmac-pvt");
    let again = verified(&astigmatic(), &run.path("astigmatic-5mm.pmc"), &[]);
    assert_eq!(
        errors(&summary).1,
        number(&again, "/interpolation_error/max_nm")
    );
    assert_eq!(summary["control_points"], again["control_points"]);
    let human = String::from_utf8_lossy(&run.output.stdout).into_owned();
    assert!(
        human.contains("  pmac-pvt  ") && human.contains("astigmatic-5mm.pmc"),
        "{human}"
    );
}

#[test]
fn an_independent_reader_finds_the_same_points_and_error() {
    let reference =
        fs::read_to_string(repository().join("tests/reference/pmac/ast-5.json")).unwrap();
    let reference: Value = serde_json::from_str(&reference).unwrap();
    let recipe = repository().join("tests/reference/pmac/ast-5.toml");
    let run = Run::of(&recipe, &[]).ends(0);
    let summary = run.summary();
    assert_eq!(summary["control_points"], reference["points"]);
    let time = number(&summary, "/cutting_time_s") - number(&reference, "/time_s");
    assert!(time.abs() < 1.0 / 4_096_000.0);
    assert!(number(&reference, "/late_quanta_max") <= 0.5);
    for axis in ["c_deg", "x_mm", "z_mm"] {
        // Half a unit of the seventh decimal; what the curvature adds in 122 ns is far below.
        assert!(number(&reference, &format!("/off/{axis}")) < 0.5001e-7);
    }
    let (program, wanted) = (
        errors(&summary).1,
        number(&reference, "/interpolation_error_nm/max"),
    );
    // 16 instants a segment see the largest error to half a percent, and 48 nearly all of it.
    assert!((program / wanted - 1.0).abs() < 5e-3, "{program} {wanted}");
    let text = run.read("ast-5.pmc");
    assert!(text.contains(reference["recipe_sha256"].as_str().unwrap()));
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_same_bytes_for_any_threads_and_settings_that_mean_the_same_path() {
    // Some blocks of revolutions, and segments of changing times.
    let small = [
        "surface={use=\"off-axis-paraboloid\", vertex_radius=\"915 mm\", off_axis_distance=\"915 mm\"}",
        "part.aperture=\"8 mm\"",
        "tolerance={interpolation=\"10 nm\", residual=\"10 nm\"}",
        "sampler.step=\"6.8 deg\"",
        "tool={nose_radius=\"1.04 mm\"}",
    ];
    let absolute = Run::of(&astigmatic(), &small).ends(0);
    let summary = absolute.summary();
    assert!(number(&summary, "/revolutions") > 3.0 * 64.0);
    costs_little(&summary);
    for settings in [
        "output.pmac-pvt={positioning=\"incremental\"}",
        "output.pmac-pvt={c_wrap=\"0-360\"}",
        "output.pmac-pvt={c_sign=-1, c_wrap=\"0-360\"}",
        "output.pmac-pvt={velocity_per=\"min\"}",
        "output.z_reference=\"centre\"",
    ] {
        let sets = [&small[..], &[settings]].concat();
        let one = Run::with(&astigmatic(), &sets, &["--threads", "1"]).ends(0);
        let three = Run::with(&astigmatic(), &sets, &["--threads", "3"]).ends(0);
        let file = "astigmatic-5mm.pmc";
        assert!(one.read(file) == three.read(file), "{settings}");
        costs_little(&one.summary());
        if settings.contains("incremental") {
            let [(path, program), (own, sums)] = [&summary, &one.summary()].map(errors);
            // A long unwrapped C is held in the controller's 36 bits, and a sum of distances is exact.
            assert!(
                path == own && (program - sums).abs() < 1e-6,
                "{program} {sums}"
            );
        }
        let again = verified(&astigmatic(), &one.path(file), &sets);
        let error = number(&again, "/interpolation_error/max_nm");
        assert_eq!(error, errors(&one.summary()).1, "{settings}");
    }
}

#[test]
fn too_few_digits_exceed_the_tolerance() {
    let coarse = ["output.pmac-pvt.position_decimals=3"];
    let run = Run::of(&astigmatic(), &coarse).ends(1);
    let summary = run.summary();
    let (path, program) = errors(&summary);
    assert!(path < 100.0 && program > 100.0);
    assert_eq!(summary["within"]["interpolation"], true);
    assert_eq!(summary["programs"][0]["within_interpolation"], false);
    let human = String::from_utf8_lossy(&run.output.stdout).into_owned();
    assert!(
        human
            .lines()
            .any(|line| line.contains("pmac-pvt") && line.ends_with("EXCEEDED"))
    );
}

#[test]
fn header_and_footer_are_the_recipes() {
    let run = Run::of(
        &astigmatic(),
        &[
            "output.pmac-pvt.header=\"; {name}|{recipe}|{points}|{time_s}|{ix90}\\nOPEN ROT\"",
            "output.pmac-pvt.footer=\"M30 {{}}\"",
        ],
    )
    .ends(0);
    let text = run.read("astigmatic-5mm.pmc");
    let begins =
        "; Astigmatic mirror, 5 mm|astigmatic-5mm.toml|4160|12.476|1000\nOPEN ROT\n; -- cut";
    assert!(text.starts_with(begins), "{text:.200}");
    assert!(text.ends_with("; -- end of path: 4160 points --\nM30 {}\n"));
}

#[test]
fn a_segment_that_is_too_long_for_the_controller_is_divided_on_its_cubic() {
    // 15 s from point to point, and 4095.9998 ms at the most.
    let slow = ["spindle.speed=\"0.1 rpm\""];
    let run = Run::of(&astigmatic(), &slow).ends(0);
    let summary = run.summary();
    costs_little(&summary);
    let points = points_of(&run.read("astigmatic-5mm.pmc"));
    const LONGEST: f64 = 16_777_215.0;
    let table = run.read("toolpath.csv");
    let steps = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap() * 4_096_000.0;
    let times: Vec<f64> = table.lines().skip(1).map(steps).collect();
    let parts = times
        .windows(2)
        .map(|pair| ((pair[1] - pair[0]).round() / LONGEST).ceil());
    let parts: f64 = parts.sum();
    assert!(
        parts > 3.9 * times.len() as f64,
        "{parts} of {}",
        times.len()
    );
    assert_eq!(points.len() as f64, parts + 1.0);
    let steps = points.windows(2).map(|pair| pair[1].0 - pair[0].0);
    assert!(steps.into_iter().all(|step| step <= LONGEST));
    let report = verified(&astigmatic(), &run.path("astigmatic-5mm.pmc"), &slow);
    assert_eq!(
        number(&report, "/interpolation_error/max_nm"),
        errors(&summary).1
    );
    assert_eq!(report["anomalies"]["count"], 0, "{}", report["anomalies"]);
}

#[test]
fn what_the_post_cannot_write_is_the_recipes_fault_and_leaves_no_file() {
    for (set, says) in [
        (
            "output.pmac-pvt.position_decimals=12",
            "too many digits with 12 decimals",
        ),
        (
            "output.pmac-pvt.header=\"{nam}\"",
            "no placeholder named `{nam}`",
        ),
        ("output.pmac-pvt.footer=\"{\"", "a single brace"),
        ("output.posts=[\"pmac\"]", "no post named `pmac`"),
    ] {
        let run = Run::of(&astigmatic(), &[set]).ends(2);
        assert!(
            stderr(&run.output).contains(says),
            "{}",
            stderr(&run.output)
        );
        assert!(!run.path("").exists(), "{set}");
    }
}

#[test]
fn a_damaged_program_is_refused_with_its_line() {
    let run = Run::of(&astigmatic(), &[]).ends(0);
    let text = run.read("astigmatic-5mm.pmc");
    let program = run.path("spoiled.PMC");
    let half: Vec<&str> = text.lines().take(text.lines().count() / 2).collect();
    for (spoiled, says) in [
        (
            text.replacen("C18:", "D18:", 1),
            "spoiled.PMC, line 20: `D18:3000` is not a word",
        ),
        (
            text.replacen("C18:3000", "C18:NaN", 1),
            "spoiled.PMC, line 20: the velocity of C",
        ),
        (half.join("\n") + "\n", "it is not complete"),
        (text.replacen("-- cutting --", "", 1), "there is no path"),
    ] {
        fs::write(&program, spoiled).unwrap();
        let output = call("verify", &astigmatic(), &[program.to_str().unwrap()], &[]);
        assert_eq!(output.status.code(), Some(4));
        let said = stderr(&output);
        assert!(said.contains(says), "{said}");
    }
}

#[test]
fn check_expects_the_programs_size() {
    let output = call("check", &astigmatic(), &["--format", "json"], &[POSTS]);
    let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
    let run = Run::of(&astigmatic(), &[]).ends(0);
    let size = run.read("astigmatic-5mm.pmc").len() as f64;
    let expected = number(&checked, "/expected/programs/0/bytes");
    assert!(
        (expected / size - 1.0).abs() < 1.0 / 3.0,
        "{expected} {size}"
    );
}

/// Axis words of a program's line, `C9:3000 X2.5:-0.2 Z0.1:55`, as (position, velocity) of C, X, Z.
fn words(line: &str) -> Option<[(f64, f64); 3]> {
    let mut found = [None; 3];
    for word in line.split_ascii_whitespace() {
        let axis = "CXZ".find(word.get(..1)?)?;
        let (position, velocity) = word.get(1..)?.split_once(':')?;
        found[axis] = Some((position.parse().ok()?, velocity.parse().ok()?));
    }
    let [c, x, z] = found;
    Some([c?, x?, z?])
}

/// Times in 1/4096 ms and axis words of the control points of a program as the post writes it.
fn points_of(program: &str) -> Vec<(f64, [(f64, f64); 3])> {
    let path = program
        .lines()
        .skip_while(|line| !line.starts_with("; -- "));
    let (mut points, mut time, mut step) = (Vec::new(), 0.0, 0.0);
    for line in path {
        if let Some(ms) = line.strip_prefix("PVT") {
            step = ms.parse::<f64>().unwrap() * 4096.0;
        } else if let Some(words) = words(line) {
            time = if points.is_empty() { 0.0 } else { time + step };
            points.push((time, words));
        }
    }
    points
}

/// A program of some 374,000 points, leads included: places and velocities to half a digit, no
/// drift of time, and an error within 0.3 nm of the path's.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_program_of_the_off_axis_paraboloid_is_its_path() {
    let recipe = repository().join("docs/recipes/off-axis-paraboloid-213mm.toml");
    let run = Run::of(&recipe, &["refine=false"]).ends(0);
    costs_little(&run.summary());
    let points = points_of(&run.read("off-axis-paraboloid-213mm.pmc"));
    let table = run.read("toolpath.csv");
    assert_eq!(points.len(), table.lines().count() - 1);
    const NOSE_RADIUS: f64 = 1.04;
    for ((time, [c, x, z]), row) in points.iter().zip(table.lines().skip(1)) {
        let row: Vec<f64> = row.split(',').map(|value| value.parse().unwrap()).collect();
        assert!(
            (time - row[0] * 4_096_000.0).abs() <= 1.0,
            "{time}: {row:?}"
        );
        let made = [row[1], row[2], row[3] - NOSE_RADIUS, row[4], row[5], row[6]];
        let read = [c.0, x.0, z.0, c.1, x.1, z.1];
        for (made, read) in made.iter().zip(read) {
            let half_a_digit = 0.5e-7 + 2.0 * f64::EPSILON * made.abs();
            assert!((made - read).abs() <= half_a_digit, "{read}: {row:?}");
        }
    }
}
