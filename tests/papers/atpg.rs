//! Whole runs of the ATPG chain, against published and independently computed figures.
//!
//! The figures of AST-5 belong to the paper's own law (`residual = "paper"`, `fit = "cubic"`,
//! 97.155 revolutions), cut outward to ρ = 2.5 mm: with steps at the whole tolerance instead of
//! the sampler's 98 % of it the program gives 99.5, 168.6, 99.3 and 323.8 nm where 99.5, 168.5,
//! 99.3 and 325 are expected.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::PathBuf;

use crate::support::bench::{Answer, Bench};
use crate::support::repository;
use serde_json::Value;

fn recipe(name: &str) -> PathBuf {
    let recipes = repository().join("docs/recipes");
    recipes.join(name)
}

/// The papers' paths run over the aperture exactly, from its middle to its rim or back.
const AS_PUBLISHED: [&str; 2] = ["path.overrun=none", "path.lead=false"];

/// Calls a command on a recipe of docs/ with changes.
fn call(command: &str, name: &str, set: &[&str]) -> Answer {
    let recipe = recipe(name);
    let fixed = [command, recipe.to_str().unwrap(), "--format", "json"];
    let set = AS_PUBLISHED
        .iter()
        .chain(set)
        .flat_map(|set| ["--set", *set]);
    Bench::empty().call(fixed.into_iter().chain(set))
}

/// Runs a recipe of docs/ with changes; gives the exit status and the summary.
fn run(name: &str, set: &[&str]) -> (i32, Value) {
    let said = call("run", name, set);
    (said.status.unwrap(), said.json())
}

const NO_REFINE: &str = "refine=false";
/// The law and direction of the figures for AST-5.
const PAPERS_LAW: [&str; 3] = [
    "feed.residual=paper",
    "feed.fit=cubic",
    "path.direction=outward",
];
const NONE: &str = "compensator.use=none";
const Z_DIRECTION: &str = "compensator.use=z-direction";
const ANALYTIC: &str = "velocity.use=analytic";
const TRIANGLE_ROTARY: &str = "velocity.use=triangle-rotary";
const THREE_POINT: &str = "velocity.use=three-point";
const NATURAL: &str = "velocity={ use = \"triangle-rotary\", ends = \"natural\" }";

fn ast_5(set: &[&str]) -> Value {
    let set: Vec<&str> = PAPERS_LAW.iter().chain(set).copied().collect();
    run("astigmatic-5mm.toml", &set).1
}

fn points(summary: &Value) -> f64 {
    summary["control_points"].as_f64().unwrap()
}

fn error_nm(summary: &Value) -> f64 {
    summary["interpolation_error"]["max_nm"].as_f64().unwrap()
}

fn close(found: f64, expected: f64, part: f64, what: &str) {
    let off = (found / expected - 1.0).abs();
    assert!(off <= part, "{what}: {found} where {expected} is expected");
}

/// Compensator, velocity solver, points, largest error in nm.
///
/// Two cells of the table are not here. Nodes of one path on another have no chain: they are in
/// the plugin's own tests. Natural ends err by the square of the path's last step, which is
/// whatever the sampler leaves over: see below.
const AT_THE_LIMIT: &[(&str, &str, f64, f64)] = &[
    (NONE, ANALYTIC, 1510.0, 99.5),
    (NONE, TRIANGLE_ROTARY, 1510.0, 168.5),
    (NONE, THREE_POINT, 1510.0, 1986.0),
    (Z_DIRECTION, ANALYTIC, 1655.0, 99.3),
    (Z_DIRECTION, TRIANGLE_ROTARY, 1655.0, 325.0),
    (Z_DIRECTION, THREE_POINT, 1655.0, 1583.0),
];

#[test]
fn sampled_at_the_limit_of_equation_10_the_solver_decides() {
    for (compensator, velocity, expected_points, expected_nm) in AT_THE_LIMIT {
        let summary = ast_5(&[NO_REFINE, compensator, velocity]);
        let what = format!("{compensator}, {velocity}");
        close(points(&summary), *expected_points, 0.01, &what);
        close(error_nm(&summary), *expected_nm, 0.1, &what);
    }
}

#[test]
fn natural_ends_spoil_what_clamped_ones_hold() {
    let clamped = error_nm(&ast_5(&[NO_REFINE, NONE, TRIANGLE_ROTARY]));
    let natural = error_nm(&ast_5(&[NO_REFINE, NONE, NATURAL]));
    assert!(natural > 5.0 * clamped, "{natural} against {clamped}");
}

/// 2,206 and 2,495 points fit a start at 24° (15 points a revolution, 1,458 in all); from the
/// sampler's own points halving ends with 1,670 and 2,600.
#[test]
fn points_that_halving_needs() {
    let start = ["sampler={ use = \"equal-angle\", step = \"24 deg\" }"];
    for (velocity, expected) in [(ANALYTIC, 2206.0), (TRIANGLE_ROTARY, 2495.0)] {
        let summary = ast_5(&[start[0], Z_DIRECTION, velocity]);
        close(points(&summary), expected, 0.05, velocity);
        assert!(error_nm(&summary) <= 100.0);
    }
}

#[test]
fn with_exact_rates_the_sampler_leaves_refinement_nothing_to_add() {
    for compensator in [NONE, Z_DIRECTION] {
        let (status, summary) = run("astigmatic-5mm.toml", &[compensator, ANALYTIC]);
        assert_eq!(summary["points_added_by_refine"], 0, "{compensator}");
        assert_eq!(status, 0, "{compensator}: {summary}");
    }
}

/// X's own error may take a thousandth of the feed. Where the law's cusps leave no room for it,
/// refinement holds the residual.
#[test]
fn with_normal_compensation_refinement_adds_what_the_residual_asks_for() {
    let set = ["compensator.use=normal", ANALYTIC];
    let (status, summary) = run("astigmatic-5mm.toml", &set);
    assert_eq!(status, 0, "{summary}");
    let added = summary["points_added_by_refine"].as_f64().unwrap();
    assert!(added > 0.0 && added <= 0.02 * points(&summary), "{added}");
}

#[test]
fn the_small_mirror_holds_both_tolerances() {
    let (status, summary) = run("astigmatic-5mm.toml", &[]);
    assert_eq!(status, 0, "{summary}");
    close(
        summary["revolutions"].as_f64().unwrap(),
        98.985,
        0.003,
        "revolutions",
    );
}

/// To X = 2.871 mm, where the contact reaches the rim at every angle, it takes 114.6 revolutions;
/// the smooth law costs 0.25 %, closing the spiral at rim and centre 1.25 revolutions.
#[test]
fn the_small_mirror_as_a_whole() {
    let whole = ["path.overrun=contact", "path.lead=true"];
    let (status, summary) = run("astigmatic-5mm.toml", &whole);
    assert_eq!(status, 0, "{summary}");
    let expected = 114.6 * 1.0025 + 1.25;
    let revolutions = summary["revolutions"].as_f64().unwrap();
    close(revolutions, expected, 0.001, "revolutions");
}

/// Revolutions and points of a large part with the paper's own law, sampled by `sampler`.
fn by_the_papers_law(name: &str, sampler: &str) -> (f64, f64) {
    let only_figures = ["output.posts=[]", "output.data=[]"];
    let papers = ["feed.residual=paper", "feed.fit=cubic", NO_REFINE, sampler];
    let set: Vec<&str> = only_figures.into_iter().chain(papers).collect();
    let (_, summary) = run(name, &set);
    (summary["revolutions"].as_f64().unwrap(), points(&summary))
}

const ATPG: &str = "sampler={ use = \"atpg\" }";
const EQUAL_ANGLE: &str = "sampler={ use = \"equal-angle\" }";

/// Published: 23,581 points of ATPG for the 35,053 of a commercial program, 0.67; here 0.78
/// against the largest equal step that holds the tolerance.
#[test]
fn the_mirror_of_50_mm_by_the_papers_law() {
    let (revolutions, atpg) = by_the_papers_law("astigmatic-50mm.toml", ATPG);
    close(revolutions, 2740.8, 1e-4, "revolutions");
    close(atpg, 23.9e3, 0.01, "points");
    let (_, equal) = by_the_papers_law("astigmatic-50mm.toml", EQUAL_ANGLE);
    close(atpg / equal, 0.779, 0.01, "ratio");
}

/// Published: 281,141 and 592,541 points, 0.47, at tolerances that are not stated.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_off_axis_paraboloid_by_the_papers_law() {
    let name = "off-axis-paraboloid-213mm.toml";
    let (revolutions, atpg) = by_the_papers_law(name, ATPG);
    assert!((revolutions - 11_685.0).abs() <= 3.0, "{revolutions}");
    close(atpg, 371e3, 0.01, "points");
    let (_, equal) = by_the_papers_law(name, EQUAL_ANGLE);
    close(equal, 619e3, 0.01, "points at equal angles");
}

/// Published: 5 min 30 s and 23,581 points, at tolerances that are not stated.
#[test]
fn the_mirror_of_the_paper_takes_as_long_and_as_many_points() {
    let (_, summary) = run("astigmatic-50mm.toml", &[NO_REFINE]);
    let number = |key: &str| summary[key].as_f64().unwrap();
    close(number("revolutions"), 2740.8, 2e-4, "revolutions");
    close(number("cutting_time_s"), 330.0, 0.01, "time");
    close(points(&summary), 23.9e3, 0.01, "points");
    assert_eq!(summary["within"]["residual"], true);
}

/// The smooth law against the feed that holds everywhere at the least: `constant` is slower, and
/// the law is within 3 % of the fastest, ∫dρ/F, of which the cubic through the paper's pairs
/// (which may exceed the feed) is the measure where it can be made.
#[test]
fn on_every_recipe_the_smooth_law_is_within_3_percent_of_the_cubic() {
    let folder = recipe("");
    let mut compared = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if !name.ends_with(".toml") {
            continue;
        }
        let revolutions = |fit: &str| {
            let feed = format!("feed={{ use = \"atpg\", fit = \"{fit}\" }}");
            let said = call("check", &name, &[&feed]);
            let checked: Option<Value> = serde_json::from_str(&said.stdout).ok();
            checked?["expected"]["revolutions"].as_f64()
        };
        let smooth = revolutions("smooth").unwrap_or_else(|| panic!("{name}"));
        if let Some(cubic) = revolutions("cubic") {
            assert!(smooth <= 1.03 * cubic, "{name}: {smooth} against {cubic}");
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared}");
}
