//! The largest spoke of a path, against a measurement apart and in closed form.
//!
//! `tests/reference/spokes/spokes.py` plays each path and averages its error over the turns of each
//! window. It shares no code with turnpath.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::PI;
use std::fs;

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::repository;

/// Largest difference of a figure from the one apart, as a part of it.
const TOLERANCE: f64 = 0.02;
/// Turns of a window of the reference.
const WINDOW: f64 = 64.0;

fn summary(recipe: &str, set: &[&str]) -> Value {
    let file = repository().join(recipe);
    let fixed = ["run", file.to_str().unwrap(), "--format", "json"];
    let none = ["--set", "output.posts=[]", "--set", "output.data=[]"];
    let set = set.iter().flat_map(|set| ["--set", set]);
    let said = Bench::empty().call(fixed.into_iter().chain(none).chain(set));
    said.ends(0).json()
}

fn number(of: &Value, pointer: &str) -> f64 {
    let found = of.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer}"))
}

#[test]
fn spokes_measure_like_the_reference() {
    let file = repository().join("tests/reference/spokes/spokes.json");
    let cases: Vec<Value> = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    assert!(cases.len() >= 4);
    for case in &cases {
        let set = case["set"].as_array().unwrap().iter();
        let set: Vec<&str> = set.filter_map(Value::as_str).collect();
        let found = summary(case["recipe"].as_str().unwrap(), &set);
        let amplitude = number(&found, "/spokes/amplitude_nm");
        let known = number(case, "/amplitude_nm");
        assert!(
            (amplitude / known - 1.0).abs() <= TOLERANCE,
            "{}: {amplitude} nm, not {known}",
            case["name"]
        );
        assert_eq!(found["spokes"]["per_turn"], case["per_turn"], "{case}");
        let [arms, known] = [
            number(&found, "/arms/amplitude_nm"),
            number(case, "/arms/amplitude_nm"),
        ];
        assert!(
            (arms / known - 1.0).abs() <= TOLERANCE,
            "{}: {arms} nm, not {known}",
            case["name"]
        );
        assert_eq!(
            found["arms"]["per_turn"], case["arms"]["per_turn"],
            "{case}"
        );
        let turn = |edge| number(&found, &format!("/arms/{edge}_mm"));
        let pitch = number(case, "/arms/turns_apart") * (turn("to") - turn("from")) / WINDOW;
        let found = number(&found, "/arms/pitch_mm");
        assert!(
            (found / pitch - 1.0).abs() < 1e-9,
            "{found} mm, not {pitch}"
        );
    }
}

/// On a plane of slope a, Z = aρ cos θ along a turn. Even steps h leave the error
/// −Z⁗h⁴u²(1 − u)²/24, and u²(1 − u)² = 1/30 − 3/π⁴ Σ cos(2πqu)/q⁴. So N steps a turn leave the
/// harmonics N ∓ 1 with half of aρh⁴/24 · 3/π⁴, times 1 ± 4/3N since Z⁗ changes along a step. A
/// window has the mean of its radii.
#[test]
fn even_steps_on_a_plane_leave_spokes_in_closed_form() {
    let set = [
        "surface={ use = \"xy-polynomial\", terms = [[1, 0, 0.01]] }",
        "compensator={ use = \"none\" }",
        "sampler={ use = \"equal-angle\", step = \"15 deg\" }",
        "tolerance.interpolation=1 um",
    ];
    let found = summary("tests/reference/spokes/conic.toml", &set);
    assert_eq!(number(&found, "/points_added_by_refine"), 0.0);
    let radius = 0.5 * (number(&found, "/spokes/from_mm") + number(&found, "/spokes/to_mm"));
    let step = PI / 12.0;
    let bump = 0.01 * radius * step * step * step * step / 24.0;
    let expected = bump * 1.5 / (PI * PI * PI * PI) * (1.0 + 4.0 / 72.0);
    let amplitude = 1e-6 * number(&found, "/spokes/amplitude_nm");
    assert!(
        (amplitude / expected - 1.0).abs() < 0.01,
        "{amplitude} mm, not {expected}"
    );
    assert_eq!(number(&found, "/spokes/per_turn"), 23.0);
    assert!(number(&found, "/spokes/to_mm") > 29.0);
}

/// Off the axis by so little, the largest step decides on all of the part, whatever it is. Of the spoke
/// a tenth stays: on the inner tenth of the part, where the largest step errs by as much less.
#[test]
fn largest_steps_that_wander_leave_little_of_the_spoke() {
    little_of_the_spoke_stays(&[30, 72, 90]);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_other_largest_steps_that_wander_leave_little_of_the_spoke() {
    little_of_the_spoke_stays(&[40, 60]);
}

fn little_of_the_spoke_stays(largest_steps: &[u32]) {
    let run = |max_step: u32, wander: bool| {
        let sampler = format!(
            "sampler={{ use = \"minimax\", max_step = \"{max_step} deg\", wander = {wander} }}"
        );
        let set = ["surface.decentre_x=0.1 mm", sampler.as_str()];
        let found = summary("tests/reference/spokes/conic.toml", &set);
        ["/control_points", "/spokes/amplitude_nm"].map(|pointer| number(&found, pointer))
    };
    for max_step in largest_steps {
        let (still, wandering) = (run(*max_step, false), run(*max_step, true));
        let what = format!("{max_step} deg: {still:?} {wandering:?}");
        assert!(wandering[1] < 0.1 * still[1], "{what}");
        assert!(wandering[0] <= 1.005 * still[0], "{what}");
    }
}

/// Near the axis the largest step decides, here on all of the part: every turn has eight steps, and
/// the spokes stand on the angles of their middles.
#[test]
fn steps_that_wander_leave_a_fifth_of_the_spoke_at_one_percent_more_points() {
    let run = |sampler: &str| {
        let found = summary(
            "tests/reference/spokes/conic.toml",
            &["surface.decentre_x=1.5 mm", sampler],
        );
        let points = number(&found, "/control_points");
        (points, number(&found, "/spokes/amplitude_nm"))
    };
    for sampler in [
        "use = \"minimax\", states = 1",
        "use = \"minimax\"",
        "use = \"atpg\"",
    ] {
        let [plain, wandering] = ["false", "true"]
            .map(|wander| run(&format!("sampler={{ {sampler}, wander = {wander} }}")));
        assert!(plain.1 > 20.0, "{sampler}: {plain:?}");
        assert!(
            wandering.1 < 0.2 * plain.1,
            "{sampler}: {plain:?} {wandering:?}"
        );
        assert!(
            wandering.0 <= 1.01 * plain.0,
            "{sampler}: {plain:?} {wandering:?}"
        );
    }
}
