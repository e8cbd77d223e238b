//! Whole runs of the three even discretizations, against Fig. 10 of the third paper: where each
//! is worst.
//!
//! Its part: Ø 40 mm, 0.05 mm/rev, 5° and 1 mm of arc; its toric radii are not given, and the
//! figure's scale is not legible. z = 0.6 mm (ρ/20)² sin 2θ stands in, with exact velocities: a
//! step of L errs by 16Kρ²L⁴/384 at the most.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::Value;

const STAND_IN: &[&str] = &[
    "refine=false",
    "part.aperture=40 mm",
    "surface.k=0.0015 /mm",
    "feed.feed=0.05 mm",
    "compensator.use=none",
    "velocity.use=analytic",
];
const EQUAL_ANGLE: &str = "sampler={ use = \"equal-angle\", step = \"5 deg\" }";
const EQUAL_ARC: &str = "sampler={ use = \"equal-arc\", spacing = \"1 mm\" }";
const INTEGRATED: &str =
    "sampler={ use = \"integrated\", spacing = \"1 mm\", max_step = \"5 deg\" }";

/// A run's summary: points, largest error in nm, and X where it is.
fn run(set: &[&str]) -> (u64, f64, f64) {
    let plain = with_table(SADDLE, "sampler", "use = \"equal-angle\"");
    let bench = Bench::with(&changed(&plain, "name =", "refine = false\nname ="));
    let set = set.iter().flat_map(|set| ["--set", *set]);
    let fixed = ["run", "recipe.toml", "--format", "json"];
    let summary: Value = bench.call(fixed.into_iter().chain(set)).json();
    let error = &summary["interpolation_error"];
    (
        summary["control_points"].as_u64().unwrap(),
        error["max_nm"].as_f64().unwrap(),
        error["at"]["x_mm"].as_f64().unwrap(),
    )
}

fn stand_in(sampler: &str) -> (u64, f64, f64) {
    run(&[STAND_IN, &[sampler]].concat())
}

fn close(found: f64, expected: f64, part: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off <= part, "{found} where {expected} is expected");
}

/// 400 turns of 72 steps; K·20²·(5°)⁴/24 = 1.4498 nm.
#[test]
fn equal_angles_are_worst_at_the_rim() {
    let (points, error, x) = stand_in(EQUAL_ANGLE);
    assert_eq!(points, 28_801);
    close(error, 1.4498, 0.01);
    assert!(x > 19.5, "{x}");
}

/// The arc of the spiral is π·20²/0.05 mm, but for the innermost turns. Steps of 90° there err by
/// about K·ρ²·(π/2)⁴/24, at ρ = 2/π mm, and more where an arc of 1 mm spans a little less.
#[test]
fn equal_arcs_are_worst_at_the_centre() {
    let (points, error, x) = stand_in(EQUAL_ARC);
    close(points as f64, 25_132.7 + 30.0, 0.002);
    assert!(error > 100.0, "{error}");
    assert!(x < 1.0, "{x}");
}

/// Worst where both steps meet, at 1 mm/5° = 11.46 mm: K·11.46²·(5°)⁴/24 = 0.4759 nm.
#[test]
fn the_integrated_steps_are_worst_where_both_meet_and_least_of_all() {
    let (points, error, x) = stand_in(INTEGRATED);
    close(error, 0.4759, 0.01);
    assert!((x - 11.46).abs() < 0.5, "{x}");
    let (by_angle, by_arc) = (stand_in(EQUAL_ANGLE).1, stand_in(EQUAL_ARC).1);
    assert!(3.0 * error < by_angle && 100.0 * error < by_arc);
    // Outside 11.46 mm arcs, inside equal angles.
    let meet = 1.0 / (5.0_f64).to_radians();
    let expected = std::f64::consts::PI * (400.0 - meet * meet) / 0.05 + 72.0 * meet / 0.05;
    close(points as f64, expected, 0.001);
}

/// The order is the toric surface's too, with the nose compensated and any solver.
#[test]
fn on_a_toric_surface_the_order_is_the_same() {
    let toric = [
        "surface={ use = \"toric\", radius_rotation = \"100 mm\", radius_base = \"60 mm\" }",
        "compensator.use=z-direction",
    ];
    for velocity in ["velocity.use=three-point", "velocity.use=triangle-rotary"] {
        let by = |sampler| run(&[STAND_IN, &toric, &[velocity, sampler]].concat());
        let (angle, arc, both) = (by(EQUAL_ANGLE), by(EQUAL_ARC), by(INTEGRATED));
        assert!(angle.2 > 15.0 && arc.2 < 2.0, "{} {}", angle.2, arc.2);
        assert!(
            both.1 < angle.1 && both.1 < arc.1,
            "{both:?} {angle:?} {arc:?}"
        );
    }
}
