//! The figures of every strategy on one small part, as they were recorded for
//! [`turnpath::FIGURES`]. Records of ablations are kept by that number: a change that moves a figure
//! raises it, and then records these figures anew with `RECORDED_FIGURES=write`.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::PathBuf;

use serde_json::{Value, json};
use turnpath::FIGURES;

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;
use crate::support::repository;

/// Each strategy of each slot on the saddle, one at a time, with and without refinement.
const LISTS: &str = r#"
[ablation]
mode = "one-at-a-time"
refine = [true]
surface = [
    { use = "conic", radius = "40 mm" },
    { use = "even-asphere", radius = "40 mm", coefficients = { 4 = 1e-5 } },
    { use = "toric", radius_rotation = "40 mm", radius_base = "30 mm" },
    { use = "sinusoidal-array", amplitude_x = "1 um", amplitude_y = "1 um", frequency_x = "0.4 /mm", frequency_y = "0.4 /mm" },
    { use = "formula", z = "k*x*y", constants = { k = "0.01 /mm" } },
]
feed = [{ use = "atpg" }, { use = "ats" }, { use = "fft-adaptive" }]
sampler = [
    { use = "atpg" },
    { use = "ats" },
    { use = "equal-arc", spacing = "0.2 mm" },
    { use = "integrated", spacing = "0.2 mm", max_step = "9 deg" },
    { use = "fft-adaptive" },
    { use = "minimax" },
]
compensator = [{ use = "normal" }, { use = "none" }]
velocity = [{ use = "analytic" }, { use = "three-point" }, { use = "area" }, { use = "linear" }]
spindle = [{ use = "surface-speed", speed = "1000 rpm", lowest = "100 rpm", cutting_speed = "1 m/min" }]
"#;
/// Digits of a recorded figure: rounding of the last ones differs between machines.
const DIGITS: usize = 8;

fn file() -> PathBuf {
    repository().join("tests/reference/recorded-figures.json")
}

/// Times, and arrays for pictures.
const NOT_RECORDED: [&str; 3] = ["planning_time_s", "measuring_time_s", "sketch"];

/// The numbers of a run by their keys, to [`DIGITS`].
fn numbers(path: &str, value: &Value, found: &mut Vec<Value>) {
    match value {
        Value::Number(number) => {
            let number = number.as_f64().unwrap();
            found.push(json!([path, format!("{number:.*e}", DIGITS - 1)]));
        }
        Value::Object(map) => {
            let known = map
                .iter()
                .filter(|(key, _)| !NOT_RECORDED.contains(&key.as_str()));
            for (key, value) in known {
                numbers(&format!("{path}/{key}"), value, found);
            }
        }
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                numbers(&format!("{path}/{index}"), value, found);
            }
        }
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// The figures of all runs, each run's as one hash under what varies, so that the file stays small.
fn figures() -> Value {
    let bench = Bench::with(&format!("{SADDLE}{LISTS}"));
    bench.line("ablate recipe.toml -o out").ends(0);
    let report: Value = serde_json::from_str(&bench.read("out/ablation.json")).unwrap();
    let run = |run: &Value| {
        let mut found = Vec::new();
        numbers("", run, &mut found);
        let kept = [
            "/control_points",
            "/interpolation_error/max_nm",
            "/residual/max_nm",
        ];
        let kept = found
            .iter()
            .filter(|one| kept.contains(&one[0].as_str().unwrap()));
        let all = serde_json::to_vec(&found).unwrap();
        json!({
            "varied": run["varied"],
            "some": kept.collect::<Vec<_>>(),
            "sha256_of_all": turnpath_host::sha256_hex(&all),
        })
    };
    let runs = report["runs"].as_array().unwrap().iter().map(run);
    json!({ "figures": FIGURES, "runs": runs.collect::<Vec<_>>() })
}

#[test]
fn figures_that_change_raise_the_number_that_records_are_kept_by() {
    let now = figures();
    if std::env::var_os("RECORDED_FIGURES").is_some_and(|how| how == "write") {
        fs::write(file(), serde_json::to_string_pretty(&now).unwrap() + "\n").unwrap();
        return;
    }
    let before: Value = serde_json::from_str(&fs::read_to_string(file()).unwrap()).unwrap();
    let runs = |of: &Value| of["runs"].as_array().unwrap().clone();
    let moved: Vec<String> = runs(&before)
        .iter()
        .zip(&runs(&now))
        .filter(|(before, now)| before != now)
        .map(|(before, now)| format!("{before}\n  now {now}"))
        .collect();
    assert!(
        moved.is_empty() && runs(&before).len() == runs(&now).len(),
        "figures have moved: raise FIGURES in crates/turnpath/src/ablation/key.rs, and call this \
         test with RECORDED_FIGURES=write\n{}",
        moved.join("\n")
    );
    assert_eq!(before["figures"], now["figures"], "RECORDED_FIGURES=write");
}
