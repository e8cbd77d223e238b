//! Every ready recipe, run by the program and held against an independent measurement of its path.
//!
//! `tests/reference/playback/measure_all.py` makes the references: playback.py, which shares
//! neither code nor method with turnpath, measures the `toolpath.csv` of each recipe.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::bench::{Bench, answer};
use crate::support::fixtures::plugin_folder;
use crate::support::repository;
use serde_json::Value;

/// The exit status of a run that holds its tolerances, and of one that does not.
const HOLDS: i32 = 0;
const EXCEEDED: i32 = 1;
/// A tolerance holds when measured ≤ this × tolerance.
const ALLOWED: f64 = 1.001;
/// Largest difference of a figure from the independent one, as a part of it.
const TOLERANCE: f64 = 0.02;
/// The same for what the nose cannot reach.
const UNREACHED_TOLERANCE: f64 = 0.01;
/// A difference that is rounding of either, nm.
const ROUNDING: f64 = 1e-5;

/// The ready recipe whose path has more points than all others together.
const LARGE: &str = "off-axis-paraboloid-213mm";
/// The hard chains that take half of the time of all.
const LARGE_HARD: [&str; 2] = ["saddle-nearly-full", "steep-bowl"];
/// The part by its form that takes half of the time of all: refinement adds most points beside its seams.
const LARGE_FORM: &str = "seam";

#[test]
fn ready_recipes_hold_and_measure_like_the_reference() {
    check_ready(|stem| stem != LARGE);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_large_ready_recipe_holds_and_measures_like_the_reference() {
    check_ready(|stem| stem == LARGE);
}

fn check_ready(chosen: fn(&str) -> bool) {
    let root = repository();
    let references = root.join("tests/reference/playback");
    let recipes = root.join("docs/recipes");
    check_all(&recipes, &references, Requirement::Holds, chosen);
}

/// Slopes of 45 deg, coarse steps, seams, blocks that end with the path, real noses on the path of a
/// point: chains whose figures are harder to measure than to make.
#[test]
fn hard_chains_measure_like_the_reference() {
    check_hard(|stem| !LARGE_HARD.contains(&stem));
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_large_hard_chains_measure_like_the_reference() {
    check_hard(|stem| LARGE_HARD.contains(&stem));
}

fn check_hard(chosen: fn(&str) -> bool) {
    let folder = repository().join("tests/reference/playback/hard");
    check_all(&folder, &folder, Requirement::AsReference, chosen);
}

/// Sums of surfaces in poses: their heights and slopes are nowhere in closed form.
#[test]
fn sums_in_poses_hold_and_measure_like_the_reference() {
    let folder = repository().join("tests/reference/playback/sums");
    check_all(&folder, &folder, Requirement::Holds, |_| true);
}

/// Recipes with nothing but a form as their tolerance: on parts of all kinds, on a path that does not
/// cover its part, and on the path of a point, where the real nose counts.
#[test]
fn parts_by_their_form_hold_and_measure_like_the_reference() {
    check_form(|stem| stem != LARGE_FORM);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_part_with_a_seam_by_its_form_holds_and_measures_like_the_reference() {
    check_form(|stem| stem == LARGE_FORM);
}

fn check_form(chosen: fn(&str) -> bool) {
    let folder = repository().join("tests/reference/playback/form");
    check_all(&folder, &folder, Requirement::Holds, chosen);
}

/// Nodes off the locus and a spindle of two speeds, both from a library: with leads, refinement,
/// time steps and a program.
#[test]
fn nodes_off_the_locus_and_a_changing_speed_measure_like_the_reference() {
    let folder = repository().join("tests/reference/playback/slots");
    let name = "wavy-two-speeds";
    let plugins = plugin_folder(&["two-speeds"]);
    let bench = Bench::with(&read(&folder.join(format!("{name}.toml"))));
    let call = |words: &str| {
        let mut command = bench.command(words.split_whitespace());
        answer(command.arg("--plugin-dir").arg(plugins.path())).ends(HOLDS)
    };
    call("run recipe.toml -o out");
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).expect("JSON");
    let reference: Value =
        serde_json::from_str(&read(&folder.join(format!("{name}.json")))).expect("JSON");
    let rows = bench.read("out/toolpath.csv").lines().count() as u64 - 1;
    let mut complaints = compare(&summary, &reference, rows);
    complaints.extend(compare_verdicts(&summary, &reference, Some(HOLDS)));
    let c = |key| format!("/axes/c/{key}");
    for (pointer, of_reference) in [
        ("/control_point_offset_nm", "/control_point_nm"),
        (&*c("max_velocity_deg_per_s"), "/spindle/highest_deg_per_s"),
        (
            &*c("max_acceleration_deg_per_s2"),
            "/spindle/acceleration_deg_per_s2",
        ),
    ] {
        complaints.extend(compare_figure(&summary, pointer, &reference, of_reference));
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
    let number = |of: &Value, pointer: &str| of.pointer(pointer).and_then(Value::as_f64);
    // Half the tolerance is no error: the points lie where the sampler placed them.
    assert!(number(&summary, "/control_point_offset_nm") > Some(49.0));
    assert!(number(&summary, "/control_point_error/max_nm") < Some(ROUNDING));
    assert!(number(&summary, "/points_added_by_refine") > Some(100.0));
    assert_eq!(summary["within"]["programs"], true);
    for file in ["toolpath.csv", "recipe.pmc"] {
        let found = call(&format!("verify recipe.toml out/{file} --format json")).json();
        let complaints = compare(&found, &reference, rows);
        assert!(complaints.is_empty(), "{file}\n{}", complaints.join("\n"));
        assert_eq!(found["control_point_offset_nm"], Value::Null);
        assert_eq!(anomalies(&found), None, "{file}");
    }
}

/// How a run must end.
#[derive(Clone, Copy)]
enum Requirement {
    /// All tolerances hold.
    Holds,
    /// Each tolerance holds exactly where the reference's figures hold it.
    AsReference,
}

/// The files of a folder with this extension, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|end| end == extension))
        .collect();
    found.sort();
    found
}

/// Checks the recipes of a folder whose names are chosen, and complains about all that differ. Every
/// reference must have its recipe, chosen or not.
fn check_all(recipes: &Path, references: &Path, expected: Requirement, chosen: fn(&str) -> bool) {
    let found = files(recipes, "toml");
    let stems: Vec<String> = found.iter().map(|recipe| stem(recipe)).collect();
    let measured = files(references, "json").into_iter();
    let left = measured.filter(|reference| !stems.contains(&stem(reference)));
    let left = left.map(|reference| format!("{}: of no recipe", reference.display()));
    let mut found = found;
    found.retain(|recipe| chosen(&stem(recipe)));
    assert!(!found.is_empty(), "no recipe in {}", recipes.display());
    let checked = found
        .iter()
        .flat_map(|recipe| check(recipe, references, expected));
    let complaints: Vec<String> = left.chain(checked).collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// A file's name without its extension.
fn stem(file: &Path) -> String {
    let stem = file.file_stem().expect("a name");
    stem.to_string_lossy().into_owned()
}

fn check(recipe: &Path, references: &Path, expected: Requirement) -> Vec<String> {
    let stem = stem(recipe);
    let Ok(reference) = fs::read_to_string(references.join(format!("{stem}.json"))) else {
        return vec![format!("{stem}: no reference; measure_all.py makes one")];
    };
    let reference: Value = serde_json::from_str(&reference).expect("JSON");
    let folder = tempfile::tempdir().expect("a folder");
    let run = Command::new(env!("CARGO_BIN_EXE_turnpath"))
        .arg("run")
        .arg(recipe)
        .arg("-o")
        .arg(folder.path())
        .output()
        .expect("turnpath runs");
    let failed = || {
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        vec![format!("{stem}: {}\n{said}", run.status)]
    };
    let summary = match (run.status.code(), expected) {
        (Some(HOLDS), _) | (Some(EXCEEDED), Requirement::AsReference) => {
            fs::read_to_string(folder.path().join("summary.json")).expect("a summary")
        }
        _ => return failed(),
    };
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let path = fs::read_to_string(folder.path().join("toolpath.csv")).expect("a path");
    let mut complaints = compare(&summary, &reference, path.lines().count() as u64 - 1);
    complaints.extend(compare_verdicts(&summary, &reference, run.status.code()));
    for file in ["csv", "pmc"]
        .iter()
        .flat_map(|end| files(folder.path(), end))
    {
        let mut verify = Command::new(env!("CARGO_BIN_EXE_turnpath"));
        let said = answer(
            verify
                .arg("verify")
                .args([recipe, &file])
                .args(["--format", "json"]),
        );
        complaints.extend(anomalies(&said.json()));
    }
    complaints
        .into_iter()
        .map(|complaint| format!("{stem}: {complaint}"))
        .collect()
}

/// What `verify` has against a file that a run wrote; nothing if its rows are the recipe's.
fn anomalies(verified: &Value) -> Option<String> {
    let anomalies = &verified["anomalies"];
    let clean = anomalies["count"] == 0 && anomalies["compared_with"] == "recipe";
    let whole = verified["within"]["whole"] != false;
    let file = &verified["file"];
    (!clean || !whole).then(|| format!("{file}: {anomalies}, {}", verified["within"]))
}

/// Where the run's verdicts differ from those of the reference's figures.
fn compare_verdicts(summary: &Value, reference: &Value, status: Option<i32>) -> Vec<String> {
    let mut complaints = Vec::new();
    let mut all = true;
    for (tolerance, pointer) in [
        ("interpolation", "/interpolation_error_nm/max"),
        ("residual", "/residual_nm/max"),
        ("form", "/form_error_nm"),
    ] {
        let limit = summary["tolerance"][format!("{tolerance}_nm")].as_f64();
        if limit.is_none() {
            // The recipe asks for another tolerance in its place.
            if !summary["within"][tolerance].is_null() {
                complaints.push(format!("within.{tolerance} without a tolerance"));
            }
            continue;
        }
        let figure = reference.pointer(pointer).and_then(Value::as_f64);
        // A figure that was not measured does not hold.
        let holds = figure
            .zip(limit)
            .is_some_and(|(figure, limit)| figure <= ALLOWED * limit);
        all &= holds;
        if summary["within"][tolerance] != holds {
            complaints.push(format!("within.{tolerance} is not {holds}: {figure:?}"));
        }
    }
    // Coverage is promised by a path with an overrun only.
    all &= summary["within"]["coverage"] != false;
    let expected = if all { HOLDS } else { EXCEEDED };
    if status != Some(expected) {
        complaints.push(format!("it ends with {status:?}, not {expected}"));
    }
    complaints
}

/// What differs between a figure and that of the reference.
fn compare_figure(
    summary: &Value,
    pointer: &str,
    reference: &Value,
    of_reference: &str,
) -> Option<String> {
    let here = summary.pointer(pointer).and_then(Value::as_f64);
    let there = reference.pointer(of_reference).and_then(Value::as_f64);
    // A path without neighbouring passes has no residual, a part without a hole no edge there: null
    // in both.
    let agree = match (here, there) {
        (Some(here), Some(there)) => (here - there).abs() <= (TOLERANCE * there).max(ROUNDING),
        _ => here == there,
    };
    (!agree).then(|| format!("{pointer} {here:?}, not {there:?}"))
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).expect("a file")
}

/// What differs between a run's summary and the reference.
fn compare(summary: &Value, reference: &Value, rows: u64) -> Vec<String> {
    let mut complaints = Vec::new();
    let points = summary["control_points"].as_u64();
    let all = summary["rows"].as_u64();
    if points != reference["control_points"].as_u64() || all != Some(rows) {
        let expected = &reference["control_points"];
        let said = format!("{points:?} points and {all:?} rows");
        complaints.push(format!("{said}, not {expected} and {rows}"));
    }
    for (pointer, of_reference) in [
        ("/interpolation_error/max_nm", "/interpolation_error_nm/max"),
        ("/interpolation_error/rms_nm", "/interpolation_error_nm/rms"),
        ("/residual/max_nm", "/residual_nm/max"),
        ("/surface_error/pv_nm", "/surface_error_nm/pv"),
        ("/surface_error/rms_nm", "/surface_error_nm/rms"),
        ("/played_cusp/max_nm", "/played_cusp_nm/max"),
        ("/real_nose/pv_nm", "/real_nose_nm/pv"),
        ("/form/pv_nm", "/form_error_nm"),
        ("/coverage/rim/height_nm", "/coverage_nm/rim"),
        ("/coverage/hole/height_nm", "/coverage_nm/hole"),
        ("/coverage/centre/height_nm", "/coverage_nm/centre"),
    ] {
        complaints.extend(compare_figure(summary, pointer, reference, of_reference));
    }
    for pointer in ["/unreached/height_um", "/unreached/volume_mm3"] {
        let figure = |of: &Value| of.pointer(pointer).and_then(Value::as_f64);
        let (here, there) = (figure(summary), figure(reference));
        let agree = match (here, there) {
            (Some(here), Some(there)) => (here - there).abs() <= UNREACHED_TOLERANCE * there,
            _ => here == there,
        };
        if !agree {
            complaints.push(format!("{pointer} {here:?}, not {there:?}"));
        }
    }
    complaints
}
