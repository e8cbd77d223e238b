//! Whole runs of the sampler `minimax` on the papers' parts, against `atpg` and against the points
//! that a prototype takes.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::repository;
use serde_json::Value;

const AST_5: &str = "astigmatic-5mm.toml";
const MLA_5: &str = "sinusoidal-array-10mm.toml";
const AST_50: &str = "astigmatic-50mm.toml";
const OAP_213: &str = "off-axis-paraboloid-213mm.toml";

/// Cut over the aperture exactly, with exact rates.
const AS_PUBLISHED: [&str; 3] = [
    "path.overrun=none",
    "path.lead=false",
    "velocity={ use = \"analytic\" }",
];

/// Runs a recipe of docs/ with a sampler; gives the summary of a run that holds everything.
fn run(name: &str, sampler: &str, set: &[&str]) -> Value {
    let recipe = repository().join("docs/recipes").join(name);
    let sampler = format!("sampler={{ {sampler} }}");
    let set = AS_PUBLISHED
        .iter()
        .chain(set)
        .copied()
        .chain([sampler.as_str()])
        .flat_map(|set| ["--set", set]);
    let fixed = ["run", recipe.to_str().unwrap(), "--format", "json"];
    let none = ["--set", "output.posts=[]", "--set", "output.data=[]"];
    let said = Bench::empty().call(fixed.into_iter().chain(none).chain(set));
    said.ends(0).json()
}

fn minimax(states: u32, max_step_deg: u32) -> String {
    format!("use = \"minimax\", states = {states}, max_step = \"{max_step_deg} deg\"")
}

fn atpg(max_step_deg: u32) -> String {
    format!("use = \"atpg\", max_step = \"{max_step_deg} deg\"")
}

fn number(summary: &Value, pointer: &str) -> f64 {
    let found = summary.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer}"))
}

fn points(summary: &Value) -> f64 {
    number(summary, "/control_points")
}

/// Checks what stays as it is with `atpg`, and what may change by how much.
fn compare(found: &Value, with_atpg: &Value, what: &str) {
    let tolerance = number(found, "/tolerance/interpolation_nm");
    let error = number(found, "/interpolation_error/max_nm");
    assert!(error <= tolerance, "{what}: {error} of {tolerance} nm");
    holds_before_refinement(found, what);
    let ratio = |pointer: &str| number(found, pointer) / number(with_atpg, pointer);
    assert_eq!(ratio("/revolutions"), 1.0, "{what}");
    let residual = ratio("/residual/max_nm");
    assert!((residual - 1.0).abs() <= 1e-4, "{what}: {residual}");
    compare_motion(found, with_atpg, what);
}

/// Checks how much Z accelerates and jerks.
fn compare_motion(found: &Value, with_atpg: &Value, what: &str) {
    let ratio = |pointer: &str| number(found, pointer) / number(with_atpg, pointer);
    let acceleration = ratio("/axes/z/max_acceleration_mm_per_s2");
    assert!(
        acceleration <= 1.05,
        "{what}: Z acceleration {acceleration}"
    );
    let jerk = ratio("/axes/z/max_jerk_mm_per_s3");
    assert!(jerk <= 1.0, "{what}: Z jerk {jerk}");
}

/// Where X decides, both samplers take nearly the same steps, and the jerk differs by what their ends
/// make of it.
fn same_motion(found: &Value, with_atpg: &Value) {
    for (pointer, most) in [
        ("/axes/z/max_acceleration_mm_per_s2", 1.05),
        ("/axes/z/max_jerk_mm_per_s3", 1.01),
    ] {
        let ratio = number(found, pointer) / number(with_atpg, pointer);
        assert!(ratio <= most, "{pointer}: {ratio}");
    }
}

/// Refinement may add a thousandth of the points.
fn holds_before_refinement(found: &Value, what: &str) {
    let added = number(found, "/points_added_by_refine");
    assert!(
        added <= 1e-3 * points(found),
        "{what}: {added} points added"
    );
}

/// X moves within the turn by the feed and by the compensator, and its own error decides. Nodes
/// beside the path would shake Z and gain nothing. The feed leaves little room for X's error, and the
/// sampler keeps to it itself.
#[test]
fn with_the_feed_ats_and_normal_compensation_z_moves_as_with_atpg() {
    let set = ["compensator={ use = \"normal\" }", "feed={ use = \"ats\" }"];
    let with_atpg = run(AST_5, &atpg(45), &set);
    for states in [3, 7, 25] {
        let found = run(AST_5, &minimax(states, 45), &set);
        assert!(points(&found) < points(&with_atpg), "{states} states");
        holds_before_refinement(&found, &format!("{states} states"));
        same_motion(&found, &with_atpg);
    }
}

/// Nodes beside the path make Z accelerate more where a wave turns. The sampler refuses those that add
/// more than a few hundredths.
fn z_accelerates_little_more_than_with_atpg(feed: &str, compensator: &str, aperture: &str) {
    let feed = format!("feed={{ use = \"{feed}\" }}");
    let compensator = format!("compensator={{ use = \"{compensator}\" }}");
    let aperture = format!("part.aperture={aperture}");
    let set = [feed.as_str(), compensator.as_str(), aperture.as_str()];
    let with_atpg = run(MLA_5, &atpg(45), &set);
    for states in [7, 25] {
        let found = run(MLA_5, &minimax(states, 45), &set);
        let what = format!("{set:?}, {states} states");
        holds_before_refinement(&found, &what);
        compare_motion(&found, &with_atpg, &what);
    }
}

/// With normal compensation X moves within the turn.
#[test]
fn z_accelerates_little_more_than_with_atpg_whatever_moves_x() {
    z_accelerates_little_more_than_with_atpg("constant", "normal", "3 mm");
    z_accelerates_little_more_than_with_atpg("atpg", "z-direction", "3 mm");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_z_accelerates_little_more_than_with_atpg_on_the_whole_array() {
    z_accelerates_little_more_than_with_atpg("constant", "normal", "10 mm");
    z_accelerates_little_more_than_with_atpg("atpg", "z-direction", "10 mm");
}

/// Recipe, largest step, points at most with one state and with seven.
const AT_MOST: &[(&str, u32, f64, Option<f64>)] = &[
    (AST_5, 45, 1510.0, Some(1272.0)),
    (MLA_5, 45, 4990.0, Some(4250.0)),
    (AST_50, 90, 16_950.0, Some(14_780.0)),
];

#[test]
fn fewer_points_than_the_bound_at_the_same_tolerance() {
    for (name, max_step, one, seven) in AT_MOST {
        let bound = run(name, &atpg(*max_step), &[]);
        let states = [(1, Some(*one)), (7, *seven)];
        for (states, most) in states {
            let Some(most) = most else { continue };
            let what = format!("{name}, {max_step} deg, {states} states");
            let found = run(name, &minimax(states, *max_step), &[]);
            compare(&found, &bound, &what);
            assert!(points(&found) <= most, "{what}: {} points", points(&found));
        }
    }
}

/// Here the largest step decides nearly everywhere: without wandering each of the 45 blocks of 64 turns
/// has 512 steps of exactly 45 deg. With it a block has one more. The inner blocks need none, since the
/// largest step errs by little there.
#[test]
fn steps_of_45_deg_on_ast_50_wander_for_a_fifth_of_a_percent() {
    let still = format!("{}, wander = false", minimax(1, 45));
    let [still, wandering] = [still, minimax(1, 45)].map(|sampler| run(AST_50, &sampler, &[]));
    let bound = run(AST_50, &atpg(45), &[]);
    for found in [&still, &wandering] {
        compare(found, &bound, "AST-50, 45 deg, 1 state");
    }
    assert!(points(&wandering) <= 22_990.0, "{}", points(&wandering));
    let more = points(&wandering) / points(&still) - 1.0;
    assert!((0.0..=0.002).contains(&more), "{more}");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_fewer_points_on_the_large_paraboloid() {
    let bound = run(OAP_213, &atpg(45), &[]);
    for (states, most) in [(1, 0.945), (7, 0.80)] {
        let found = run(OAP_213, &minimax(states, 45), &[]);
        compare(&found, &bound, &format!("{states} states"));
        let part = points(&found) / points(&bound);
        assert!(part <= most, "{states} states: {part} of the points");
    }
}

/// A tenth of the feed's thousandth for X's own error took 4,238 points, at a residual of 99.967 nm.
#[test]
fn with_normal_compensation_x_may_err_by_a_thousandth_of_the_feed() {
    let normal = ["compensator={ use = \"normal\" }"];
    let with_atpg = run(AST_5, &atpg(45), &normal);
    let found = run(AST_5, &minimax(7, 45), &normal);
    same_motion(&found, &with_atpg);
    holds_before_refinement(&found, "seven states");
    for found in [with_atpg, found] {
        assert!(points(&found) <= 0.60 * 4238.0, "{}", points(&found));
        let residual = number(&found, "/residual/max_nm");
        assert!(residual <= 99.967 + 0.2, "{residual}");
    }
}
