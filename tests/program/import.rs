//! `turnpath import`: recipes of lens designs, and what is refused.
//!
//! `tests/reference/lens` has the files, the heights of their surfaces by other programs, and the
//! script that makes both.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::PathBuf;

use serde_json::Value;

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::changed;
use crate::support::repository;

/// Largest difference of a height from another program's, mm.
const HEIGHT: f64 = 1e-13;

fn lens(file: &str) -> PathBuf {
    repository().join("tests/reference/lens/files").join(file)
}

fn cases() -> Vec<Value> {
    let file = repository().join("tests/reference/lens/lens.json");
    let all: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    all["cases"].as_array().unwrap().clone()
}

/// The recipe of a case in `recipe.toml`.
fn imported(case: &Value) -> Bench {
    let bench = Bench::empty();
    let file = lens(case["file"].as_str().unwrap());
    let words = case["words"].as_array().unwrap();
    let words = words.iter().map(|word| word.as_str().unwrap());
    let ends = ["import", file.to_str().unwrap(), "-o", "recipe.toml"];
    let said = bench.call(ends.into_iter().chain(words)).ends(0);
    assert_eq!(said.stdout, "");
    bench
}

#[test]
fn the_surfaces_of_all_designs_have_the_heights_that_other_programs_read() {
    let all = cases();
    assert_eq!(all.len(), 12);
    for case in &all {
        let bench = imported(case);
        let name = case["file"].as_str().unwrap();
        let count = case["grid"].as_u64().unwrap();
        let level = match case["decentred"].as_bool().unwrap() {
            true => " --set part.pose.level=false",
            false => "",
        };
        let line = format!("sag recipe.toml --grid {count} -o -{level}");
        let said = bench.line(&line).ends(0).stdout;
        let rows: Vec<Vec<f64>> = said
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|one| one.parse().unwrap()).collect())
            .collect();
        let half = case["half"].as_f64().unwrap();
        assert!((rows[0][0] + half).abs() < 1e-12, "{name}: {:?}", rows[0]);
        for heights in case["heights"].as_array().unwrap() {
            let wanted = heights["z"].as_array().unwrap();
            assert_eq!(rows.len(), wanted.len());
            for (row, wanted) in rows.iter().zip(wanted) {
                let (found, wanted) = (row[2], wanted.as_f64().unwrap());
                assert!(
                    (found - wanted).abs() < HEIGHT,
                    "{name} at {}, {}: {found}, and {wanted} by {}",
                    row[0],
                    row[1],
                    heights["by"]
                );
            }
        }
    }
}
