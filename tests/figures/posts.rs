//! All posts: their programs are written, read back from their own text, measured and verified.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use turnpath_core::toolpath::SegmentShape;
use turnpath_post::{POST_NAMES, POSTS, Post};

use crate::support::repository;

/// The largest difference between the error of a program of cubics and that of the path, nm: the cost
/// of 7 decimals.
const COST_NM: f64 = 0.3;
/// The part of the tolerance of interpolation that straight lines may take, by default.
const CHORD_SHARE: f64 = 0.5;

fn call(command: &str, recipe: &Path, rest: &[&str]) -> Output {
    let mut call = Command::new(env!("CARGO_BIN_EXE_turnpath"));
    call.arg(command).arg(recipe).args(rest);
    let posts = POST_NAMES.join("\", \"");
    call.args(["--set", &format!("output.posts=[\"{posts}\"]")]);
    call.args(["--set", "output.nanotech-g93.f_means=1/min"]);
    // Channels of TwinCAT that reach farther than by default: what they refuse is tested in tests/program.
    for word in ["beckhoff-poly.c_limit", "beckhoff-g93.c_limit"] {
        call.args(["--set", &format!("output.{word}=1e7deg")]);
    }
    // LinuxCNC of today on a fast machine: what it refuses is tested in tests/program.
    for word in ["lowest_rate=0mm/min", "servo_period=10us"] {
        call.args(["--set", &format!("output.linuxcnc-g93.{word}")]);
    }
    call.output().unwrap()
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// A length as the header shows it, from nm.
fn shown(error: f64) -> String {
    match error < 1e4 {
        true => format!("{error:.2} nm"),
        false => format!("{:.2} um", error / 1e3),
    }
}

/// Runs a recipe with all posts. Each program holds the tolerance or the status is 1, and its digits
/// and times cost what seven decimals cost.
fn all_posts_carry(recipe: &Path, rest: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = call(
        "run",
        recipe,
        &[&["-o", out.to_str().unwrap()], rest].concat(),
    );
    let said = String::from_utf8_lossy(&run.stderr);
    let status = run.status.code();
    assert!(
        matches!(status, Some(0 | 1)),
        "{}: {said}",
        recipe.display()
    );
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let path = number(&summary, "/interpolation_error/max_nm");
    let tolerance = number(&summary, "/tolerance/interpolation_nm");
    let programs = summary["programs"].as_array().unwrap();
    let within = summary["within"].as_object().unwrap();
    let path_holds = within
        .iter()
        .all(|(what, holds)| what == "programs" || *holds != Value::Bool(false));
    assert_eq!(programs.len(), POSTS.len());
    for (program, post) in programs.iter().zip(POSTS) {
        assert_eq!(program["post"], post.name);
        let error = number(program, "/interpolation_error_nm");
        let raised = number(program, "/raised_by_nm");
        assert!((error - path - raised).abs() < 1e-6, "{program} {path}");
        assert_cost(program, post, (path, tolerance));
        let judged = ["interpolation", "residual", "coverage"].map(|what| format!("within_{what}"));
        let exceeded = judged.iter().any(|key| program[key] == false);
        assert!(!exceeded || status == Some(1), "{program}");
        let file = out.join(program["file"].as_str().unwrap());
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(summary["recipe"]["sha256"].as_str().unwrap()));
        // The header has the figures of the report.
        let verified = format!(
            "verified on this text: interpolation error {}",
            shown(error)
        );
        assert!(text.contains(&verified), "{}: {verified}", recipe.display());
        let verify = call(
            "verify",
            recipe,
            &[&[file.to_str().unwrap(), "--format", "json"], rest].concat(),
        );
        // One program may be beyond its tolerance where the path and the others hold theirs.
        let judged = i32::from(exceeded || !path_holds);
        assert_eq!(verify.status.code(), Some(judged), "{}", post.name);
        let report: Value = serde_json::from_slice(&verify.stdout).unwrap();
        assert_eq!(
            number(&report, "/interpolation_error/max_nm"),
            error,
            "{}",
            post.name
        );
        if post.shape == SegmentShape::Linear {
            for what in ["residual", "coverage"] {
                assert_eq!(program[what], report[what], "{}", post.name);
            }
        }
        assert_eq!(
            report["anomalies"]["count"], 0,
            "{}: {}",
            post.name, report["anomalies"]
        );
    }
}

/// A program of cubics costs its digits. One of straight lines has some lines for each segment. Where the
/// path holds the tolerance, they take no more than their share of it.
fn assert_cost(program: &Value, post: &Post, (path, tolerance): (f64, f64)) {
    let raised = number(program, "/raised_by_nm");
    let name = post.name;
    match post.shape {
        SegmentShape::Cubic => {
            assert!(raised.abs() < COST_NM, "{name}: {raised}");
            assert!(program["straight_lines"].is_null(), "{program}");
            assert!(program.get("residual").is_none(), "{program}");
        }
        SegmentShape::Linear => {
            let holds = path <= tolerance;
            assert!(
                !holds || raised < CHORD_SHARE * tolerance,
                "{name}: {raised}"
            );
            let each = number(program, "/straight_lines/per_segment");
            assert!((1.0..100.0).contains(&each), "{name}: {each}");
        }
    }
}

#[test]
fn all_posts_carry_a_path_with_leads_within_its_tolerance() {
    let recipe = repository().join("docs/recipes/astigmatic-5mm.toml");
    all_posts_carry(&recipe, &[]);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_all_posts_carry_all_ready_recipes_within_their_tolerances() {
    for folder in ["docs/recipes", "docs/recipes/surfaces"] {
        let mut recipes = 0;
        for entry in fs::read_dir(repository().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|end| end == "toml") {
                all_posts_carry(&path, &["--set", "refine=false"]);
                recipes += 1;
            }
        }
        assert!(recipes > 3, "{folder}");
    }
}
