//! Whole runs of FFT-adaptive planning on the part of Zhong et al., against the published figures
//! and independently computed ones.
//!
//! MLA-5: z = 5 µm (cos 2π0.4x + cos 2π0.4y), radius 5 mm, e = 20 nm. The paper's errors are of
//! straight segments on the bare surface. Its conventional path (128,000 points, 58 nm) is in
//! `velocities.rs`.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, with_table};
use serde_json::Value;
use turnpath_core::Scalar;

fn recipe() -> String {
    let lines = [
        (
            "surface",
            "use = \"sinusoidal-array\"\nform = \"sum\"\namplitude_x = \"5 um\"\namplitude_y = \
             \"5 um\"\nfrequency_x = \"0.4 /mm\"\nfrequency_y = \"0.4 /mm\"",
        ),
        ("part", "aperture = \"10 mm\""),
        (
            "tolerance",
            "interpolation = \"20 nm\"\nresidual = \"100 nm\"",
        ),
        (
            "path",
            "direction = \"outward\"\noverrun = \"none\"\nlead = false",
        ),
        ("compensator", "use = \"none\""),
        ("velocity", "use = \"linear\""),
    ];
    let mut recipe = SADDLE.to_owned();
    for (table, lines) in lines {
        recipe = with_table(&recipe, table, lines);
    }
    recipe
}

/// Exit status and summary of a run; unrefined unless `set` says otherwise.
fn run(set: &[&str]) -> (i32, Value) {
    let bench = Bench::with(&recipe());
    let fixed = [
        "run",
        "recipe.toml",
        "--format",
        "json",
        "--set",
        "refine=false",
    ];
    let set = set.iter().flat_map(|set| ["--set", *set]);
    let said = bench.call(fixed.into_iter().chain(set));
    (said.status.unwrap(), said.json())
}

const HALF: &str = "feed={ use = \"fft-adaptive\", limit_residual = false }";
const FULL: &str = "feed={ use = \"fft-adaptive\", chord = \"full\", limit_residual = false }";
const STEP: &str = "sampler={ use = \"fft-adaptive\" }";
const START: &str = "sampler={ use = \"fft-adaptive\", curvature = \"start\" }";

fn number(summary: &Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap()
}

fn error_nm(summary: &Value) -> f64 {
    number(&summary["interpolation_error"], "max_nm")
}

fn close(found: f64, expected: f64, part: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off <= part, "{found} where {expected} is expected");
}

/// Published: 122 revolutions, 23,187 points and 26 nm; computed for the step's own curvature:
/// 21,130 points and 20.05 nm.
#[test]
fn the_lens_array_by_half_chords_along_the_radius_and_whole_ones_along_the_cut() {
    let (_, summary) = run(&[HALF, STEP]);
    assert_eq!(number(&summary, "revolutions").ceil(), 122.0);
    close(number(&summary, "control_points"), 21_130.0, 0.01);
    assert!((error_nm(&summary) - 20.05).abs() <= 0.2, "{summary}");
}

#[test]
fn the_printed_chord_makes_half_as_many_revolutions() {
    let (_, summary) = run(&[FULL, STEP]);
    assert_eq!(number(&summary, "revolutions").ceil(), 61.0);
}

/// z = 5 µm (cos 2π0.4x + cos 2π0.4y) at (ρ, θ), nm.
fn height_nm(rho: f64, theta: f64) -> f64 {
    let (sin, cos) = Scalar::sin_cos(theta);
    let wave = |along: f64| Scalar::cos(TAU * 0.4 * along);
    5e3 * (wave(rho * cos) + wave(rho * sin))
}

/// What the printed rule allows at a radius: the largest error of a step of `longest` rad along the
/// circle that begins at an inflection, nm.
fn from_inflections(rho: f64, longest: f64) -> f64 {
    const PLACES: i32 = 1440;
    let at = |i: f64| height_nm(rho, TAU * i / f64::from(PLACES));
    let second = |i: f64| at(i - 0.5) - 2.0 * at(i) + at(i + 0.5);
    let inflections = (0..PLACES).map(f64::from).filter_map(|i| {
        let (from, to) = (second(i), second(i + 1.0));
        (from * to < 0.0).then(|| i + from / (from - to))
    });
    let error = |i: f64| {
        let steps = longest / TAU * f64::from(PLACES);
        let (from, to) = (at(i), at(i + steps));
        let off = |s: f64| (from + s * (to - from) - at(i + s * steps)).abs();
        (1..16)
            .map(|j| off(f64::from(j) / 16.0))
            .fold(0.0, f64::max)
    };
    inflections.map(error).fold(0.0, f64::max)
}

/// Computed independently: 17,309 points and 3.45 µm with 72 radial profiles, 17,405 and 3.25 µm
/// with 360. Steps from near an inflection make rounding grow 10¹²-fold over a turn, so counts are
/// known to 1 %, and errors to what a step of Δθ_ct from an inflection itself leaves. Harmonics 4,
/// 8, 12 and 16 reach 20 nm from ρ = 0.316, 1.313, 2.531 and 3.844 mm on, and a turn keeps the one
/// that it began with over a feed of 36 µm.
#[test]
fn as_printed_steps_go_over_crests_that_they_have_not_seen() {
    let last_circles = [(1.313, 45.0), (2.531, 22.5), (3.844, 15.0), (4.964, 11.25)];
    let errors = last_circles.map(|(rho, step)| from_inflections(rho + 0.036, step * TAU / 360.0));
    let bound = errors.into_iter().fold(0.0, f64::max);
    close(bound, 3801.0, 0.002);
    for (angles, points, error) in [(72, 17_309.0, 3450.0), (360, 17_405.0, 3249.0)] {
        let feed =
            format!("feed={{ use = \"fft-adaptive\", limit_residual = false, angles = {angles} }}");
        let (_, summary) = run(&[&feed, START]);
        close(number(&summary, "control_points"), points, 0.01);
        close(error_nm(&summary), error, 0.01);
        assert!(error_nm(&summary) < bound);
    }
}

/// Fig. 4: "the form error of the adaptive toolpath is independent of radius", here and where the
/// chord's own rule is broken.
#[test]
fn refined_it_holds_whatever_is_played() {
    let (status, summary) = run(&[HALF, START, "refine=true", "tolerance.residual=700 nm"]);
    assert_eq!(status, 0, "{summary}");
    assert!(error_nm(&summary) <= 20.02);
}

/// The chord does not depend on the nose: a nose of 1 mm leaves cusps of 600 nm. The limit holds the
/// tolerance of 100 nm in both directions.
#[test]
fn the_residual_is_held_only_where_the_feed_is_limited() {
    let (_, free) = run(&[HALF, STEP]);
    assert!(number(&free["residual"], "max_nm") > 500.0);
    for direction in ["path.direction=inward", "path.direction=outward"] {
        let limited = [
            "feed={ use = \"fft-adaptive\" }",
            STEP,
            "compensator.use=z-direction",
            "velocity.use=analytic",
            "refine=true",
            direction,
        ];
        let (status, summary) = run(&limited);
        assert_eq!(status, 0, "{summary}");
        let residual = number(&summary["residual"], "max_nm");
        assert!((95.0..=100.0).contains(&residual), "{residual}");
    }
}
