//! Every ready recipe, run by the program and held against an independent measurement of its path.
//!
//! `tests/reference/playback/measure_all.py` makes the references: playback.py, which shares
//! neither code nor method with turnpath, measures the `toolpath.csv` of each recipe.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// The exit status of a run that holds its tolerances, and of one that does not.
const HOLDS: i32 = 0;
const EXCEEDED: i32 = 1;
/// Largest difference of a figure from the independent one, as a part of it.
const TOLERANCE: f64 = 0.02;
/// A difference that is rounding of either, nm.
const ROUNDING: f64 = 1e-5;

#[test]
fn ready_recipes_hold_and_measure_as_the_reference_says() {
    let root = repository();
    let references = root.join("tests/reference/playback");
    check_all(&root.join("docs/recipes"), &references, &[HOLDS]);
}

/// Steep slopes, noses that hardly fit, coarse steps, blocks that end with the path: chains whose
/// figures are harder to measure than to make.
#[test]
fn hard_chains_measure_as_the_reference_says() {
    let folder = repository().join("tests/reference/playback/hard");
    check_all(&folder, &folder, &[HOLDS, EXCEEDED]);
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Checks all recipes of a folder and complains about all that differ.
fn check_all(recipes: &Path, references: &Path, allowed: &[i32]) {
    let mut found: Vec<PathBuf> = fs::read_dir(recipes)
        .expect("the folder of recipes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "no recipe in {}", recipes.display());
    let complaints: Vec<String> = found
        .iter()
        .flat_map(|recipe| check(recipe, references, allowed))
        .collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

fn check(recipe: &Path, references: &Path, allowed: &[i32]) -> Vec<String> {
    let stem = recipe.file_stem().expect("a name").to_string_lossy();
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
    if !run
        .status
        .code()
        .is_some_and(|code| allowed.contains(&code))
    {
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        return vec![format!("{stem}: {}\n{said}", run.status)];
    }
    let summary = fs::read_to_string(folder.path().join("summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let path = fs::read_to_string(folder.path().join("toolpath.csv")).expect("a path");
    compare(&summary, &reference, path.lines().count() as u64 - 1)
        .into_iter()
        .map(|complaint| format!("{stem}: {complaint}"))
        .collect()
}

/// What differs between a run's summary and the reference.
fn compare(summary: &Value, reference: &Value, rows: u64) -> Vec<String> {
    let mut complaints = Vec::new();
    let points = summary["control_points"].as_u64();
    if points != reference["control_points"].as_u64() || points != Some(rows) {
        let expected = &reference["control_points"];
        complaints.push(format!("{points:?} points, {rows} rows, not {expected}"));
    }
    for pointer in [
        "/interpolation_error_nm/max",
        "/interpolation_error_nm/rms",
        "/residual_nm/max",
    ] {
        let figure = |of: &Value| of.pointer(pointer).and_then(Value::as_f64);
        let (here, there) = (figure(summary), figure(reference));
        // A path without neighbouring passes has no residual: null in both.
        let agree = match (here, there) {
            (Some(here), Some(there)) => (here - there).abs() <= (TOLERANCE * there).max(ROUNDING),
            _ => here == there,
        };
        if !agree {
            complaints.push(format!("{pointer} {here:?}, not {there:?}"));
        }
    }
    complaints
}
