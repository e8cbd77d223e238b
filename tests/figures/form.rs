//! `tolerance.form` over whole programs: whether a path makes good use of it, whatever the chain,
//! and how it ends where none can hold it. `recipes` holds the figure against the reference.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Bench, answer};
use crate::support::recipe::{SADDLE, changed, with_table};
use crate::support::repository;
use serde_json::Value;

/// The part of the form that a path must use.
const GOOD_USE: std::ops::RangeInclusive<f64> = 0.85..=1.0;
const HOLDS: i32 = 0;
const EXCEEDED: i32 = 1;

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// A saddle of 2 mm with nothing but a form as its tolerance.
fn saddle(form: &str) -> String {
    let small = with_table(SADDLE, "part", "aperture = \"2 mm\"");
    with_table(&small, "tolerance", &format!("form = \"{form}\""))
}

/// The summary of a run that ends with this status.
fn summary(bench: &Bench, status: i32, sets: &[&str]) -> Value {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let run = ["run", "recipe.toml", "-o", "out", "--format", "json"];
    let words = run.into_iter().chain(sets);
    answer(&mut bench.command(words)).ends(status).json()
}

/// The part of the form that a path uses.
fn used(summary: &Value) -> f64 {
    number(summary, "/form/pv_nm") / number(summary, "/form/tolerance_nm")
}

#[track_caller]
fn assert_good_use(summary: &Value, what: &str) {
    let (used, rounds) = (used(summary), number(summary, "/form/rounds"));
    assert!(
        GOOD_USE.contains(&used) && rounds <= 5.0,
        "{what}: {used} after {rounds} paths"
    );
    assert_eq!(summary["within"]["form"], true, "{what}");
}

/// Straight segments, a spline, a part with a hole, and paths that do not cover the part.
#[test]
fn whatever_the_chain_a_path_makes_good_use_of_its_form() {
    let bench = Bench::with(&saddle("150 nm"));
    for sets in [
        &["velocity={ use = \"linear\" }"][..],
        &[
            "velocity={ use = \"three-point\" }",
            "path.direction=outward",
        ],
        &[
            "part.inner=0.8 mm",
            "path.overrun=contact",
            "path.lead=true",
        ],
        &["path.overrun=0.1 mm"],
        &["compensator={ use = \"normal\" }", "path.overrun=contact"],
        &[
            "feed={ use = \"constant\", feed = \"20 um/rev\" }",
            "sampler={ use = \"atpg\" }",
        ],
        &["tolerance.residual=40 nm", "sampler={ use = \"atpg\" }"],
        &[
            "feed={ use = \"constant\", feed = \"20 um/rev\" }",
            "sampler.step=18 deg",
        ],
        &["tolerance.residual=40 nm", "sampler.step=18 deg"],
        &["tolerance.interpolation=5 nm"],
    ] {
        let found = summary(&bench, HOLDS, sets);
        assert_good_use(&found, sets[0]);
        let residual = &found["tolerance"]["residual_nm"];
        assert_eq!(found["within"]["residual"].is_null(), residual.is_null());
        assert!(found["form"]["decided_by_recipe"].is_null(), "{sets:?}");
    }
}

/// A feed of the recipe and steps that are finer than the form needs: no tolerance makes this path
/// coarser. It holds, leaves most of the form, and says why.
#[test]
fn where_feed_and_steps_are_given_the_report_says_that_they_decide_the_form() {
    let bench = Bench::with(&saddle("150 nm"));
    let given = "feed={ use = \"constant\", feed = \"20 um/rev\" }";
    let found = summary(&bench, HOLDS, &[given]);
    assert_eq!(found["form"]["decided_by_recipe"], true, "{found}");
    assert!(used(&found) < *GOOD_USE.start(), "{}", found["form"]);
    let run = ["run", "recipe.toml", "-o", "out", "--set", given];
    let said = bench.call(run).ends(HOLDS).stdout;
    assert!(
        said.contains("the recipe's own feed and steps decide it"),
        "{said}"
    );
    let too_large = "feed={ use = \"constant\", feed = \"50 um/rev\" }";
    let found = summary(&bench, EXCEEDED, &[too_large]);
    assert_eq!(found["form"]["decided_by_recipe"], true, "{found}");
}

/// A run, its programs and the files on their own: one figure and one verdict.
#[test]
fn run_program_and_verify_judge_the_same_form() {
    let with_program = changed(
        &saddle("150 nm"),
        "[feed]",
        "[output]\nposts = [\"pmac-pvt\"]\n\n[feed]",
    );
    let bench = Bench::with(&with_program);
    let found = summary(&bench, HOLDS, &[]);
    assert_good_use(&found, "the saddle");
    assert_eq!(found["within"]["programs"], true);
    assert_eq!(found["programs"][0]["within_interpolation"], Value::Null);
    let of_program = number(&found, "/programs/0/form_error_nm");
    for (file, pv) in [
        ("toolpath.csv", number(&found, "/form/pv_nm")),
        ("recipe.pmc", of_program),
    ] {
        let verify = format!("verify recipe.toml out/{file} --format json");
        let verified = bench.line(&verify).ends(HOLDS).json();
        assert!(
            (number(&verified, "/form/pv_nm") / pv - 1.0).abs() < 1e-9,
            "{file}"
        );
        assert_eq!(verified["form"]["rounds"], Value::Null);
        let strict = format!("{verify} --set tolerance.form={}nm", 0.99 * pv);
        let verified = bench.line(&strict).ends(EXCEEDED).json();
        assert_eq!(verified["within"]["form"], false);
    }
    // Digits of 100 nm are more than the form.
    let coarse = summary(&bench, EXCEEDED, &["output.pmac-pvt.position_decimals=4"]);
    assert_eq!(coarse["within"]["form"], true);
    assert_eq!(coarse["programs"][0]["within_form"], false);
    let rows = |of: &Value| number(of, "/rows");
    assert_eq!(rows(&coarse), rows(&found));
}

/// The cusps of the recipe's own feed, and a form below what a program can say: after two paths the
/// run knows. Without refinement there is one.
#[test]
fn a_form_that_no_path_can_hold_ends_soon_and_honestly() {
    let bench = Bench::with(&saddle("150 nm"));
    let cusps = "feed={ use = \"constant\", feed = \"50 um/rev\" }";
    let found = summary(&bench, EXCEEDED, &[cusps]);
    assert_eq!(found["within"]["form"], false);
    assert!(number(&found, "/form/rounds") <= 3.0, "{}", found["form"]);
    let once = summary(&bench, HOLDS, &["refine=false"]);
    assert_eq!(number(&once, "/form/rounds"), 1.0);
    let tiny = [
        "part.aperture=10 um",
        "tolerance.form=0.001 nm",
        "output.posts=[\"pmac-pvt\"]",
    ];
    let found = summary(&bench, EXCEEDED, &tiny);
    assert_eq!(found["programs"][0]["within_form"], false);
    assert!(number(&found, "/form/rounds") <= 5.0);
}

/// The path of a form is made again by the split of its summary, or by the search that a run makes.
/// A summary of another recipe says nothing.
#[test]
fn a_file_of_a_form_is_as_its_recipe_gives_it_with_and_without_its_summary() {
    let bench = Bench::with(&saddle("150 nm"));
    summary(&bench, HOLDS, &[]);
    let anomalies = |file: &str| {
        let verify = format!("verify recipe.toml {file} --format json");
        let found = bench.line(&verify).ends(HOLDS).json();
        assert_eq!(found["anomalies"]["compared_with"], "recipe", "{found}");
        number(&found, "/anomalies/count")
    };
    assert_eq!(anomalies("out/toolpath.csv"), 0.0);
    bench.write("toolpath.csv", bench.read("out/toolpath.csv"));
    assert_eq!(anomalies("toolpath.csv"), 0.0);
    let mut other: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    other["form"]["residual_nm"] = 1.0.into();
    other["recipe"]["sha256"] = "0".repeat(64).into();
    bench.write("summary.json", other.to_string());
    assert_eq!(anomalies("toolpath.csv"), 0.0);
}

/// Each variant of an ablation has a split of its own; `check` shows the first one.
#[test]
fn ablate_and_check_know_the_form() {
    let lists = "[ablation]\nrefine = [true]\ntolerance.form = [\"150 nm\", \"400 nm\"]\n";
    let bench = Bench::with(&format!("{}\n{lists}", saddle("150 nm")));
    let columns = "--columns points,form,form-residual,form-rounds,servo-max";
    let said = bench
        .line(&format!("ablate recipe.toml -o abl {columns}"))
        .ends(HOLDS);
    let report: Value = serde_json::from_str(&bench.read("abl/ablation.json")).unwrap();
    let runs = report["runs"].as_array().unwrap();
    let refined: Vec<&Value> = runs.iter().filter(|run| run["refine"] == true).collect();
    assert!(refined.len() == 2, "{said}");
    for (run, form) in refined.iter().zip([150.0, 400.0]) {
        assert_eq!(number(run, "/form/tolerance_nm"), form);
        assert_good_use(run, "a variant");
    }
    let header = bench.read("abl/ablation.csv");
    assert!(
        header.starts_with("run,") && header.contains("within_form,"),
        "{header}"
    );
    let checked = bench
        .line("check recipe.toml --format json")
        .ends(HOLDS)
        .json();
    assert!((number(&checked, "/form/residual_nm") - 100.0).abs() < 1e-9);
    assert_eq!(checked["form"]["pv_nm"], Value::Null);
}

/// The papers' parts, whole.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_whole_parts_make_good_use_of_their_form() {
    for name in [
        "astigmatic-5mm",
        "sinusoidal-array-10mm",
        "off-axis-paraboloid-50mm",
        "toric-40mm",
    ] {
        let file = repository().join(format!("docs/recipes/{name}.toml"));
        let bench = Bench::with(&fs::read_to_string(file).unwrap());
        // The toric's own feed of 50 um/rev leaves 345 nm, and its path takes the nose radius as 0: the real
        // nose gouges by 60 um.
        let own = [
            "tolerance={ form = \"150 nm\" }",
            "feed={ use = \"constant\" }",
            "compensator={ use = \"z-direction\" }",
        ];
        let sets = if name == "toric-40mm" {
            &own[..]
        } else {
            &own[..1]
        };
        assert_good_use(&summary(&bench, HOLDS, sets), name);
    }
}

/// A nose that rides over the seams of a lattice.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_beside_seams_a_path_makes_good_use_of_its_form() {
    let file = repository().join("tests/reference/playback/hard/seams.toml");
    let bench = Bench::with(&fs::read_to_string(file).unwrap());
    for (aperture, overrun) in [("2", "contact"), ("1.2", "none")] {
        let sets = [
            format!("part.aperture={aperture} mm"),
            format!("path.overrun={overrun}"),
            "tolerance={ form = \"300 nm\" }".to_owned(),
            "feed={ use = \"constant\" }".to_owned(),
        ];
        let sets = sets.each_ref().map(String::as_str);
        assert_good_use(&summary(&bench, HOLDS, &sets), overrun);
    }
}
