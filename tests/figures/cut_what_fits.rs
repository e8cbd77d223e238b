//! `interference = "cut-what-fits"` end to end: refused without it, and cut by first touch
//! with it. The unreached height is held against a brute-force closing of the sections by the nose.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{changed, with_table};
use serde_json::Value;
use turnpath_core::{DEG, Scalar};

/// A lattice with 1 mm from crest to crest; its hollows have radii down to 2.53 mm.
const LATTICE: &str = r#"format = 1
name = "Lattice"

[part]
aperture = "2 mm"

[surface]
use = "sinusoidal-array"
amplitude_x = "10 um"
amplitude_y = "10 um"
frequency_x = "1 /mm"
frequency_y = "1 /mm"
form = "sum"

[tool]
nose_radius = "3 mm"
interference = "cut-what-fits"

[tolerance]
interpolation = "100 nm"
residual = "500 nm"

[spindle]
speed = "100 rpm"

[path]
overrun = "none"
lead = false

[feed]
use = "constant"
feed = "25 um/rev"

[sampler]
use = "equal-angle"
step = "6 deg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"
"#;

/// The lattice's height.
fn height(x: f64, y: f64) -> f64 {
    0.01 * (Scalar::cos(TAU * x) + Scalar::cos(TAU * y))
}

/// The lattice's radial section at an angle.
fn section(theta: f64) -> impl Fn(f64) -> f64 {
    let (sin, cos) = Scalar::sin_cos(theta);
    move |rho| height(rho * cos, rho * sin)
}

fn summary(said: &Answer) -> Value {
    serde_json::from_str(&said.stdout).expect("JSON")
}

fn number(of: &Value, pointer: &str) -> f64 {
    of.pointer(pointer).and_then(Value::as_f64).expect(pointer)
}

/// How deep the nose cuts into the lattice at the worst control point of `toolpath.csv`, mm, with
/// the edge `reach` mm to either side and looked at every micrometre.
fn deepest(bench: &Bench, radius: f64, reach: f64) -> f64 {
    let path = bench.read("out/toolpath.csv");
    let places = (reach * 1e3) as i32;
    let mut deepest = f64::NEG_INFINITY;
    for line in path.lines().skip(1) {
        let row: Vec<f64> = line
            .split(',')
            .map(|v| v.parse().expect("a number"))
            .collect();
        let (profile, x, z) = (section(row[1] * DEG), row[2], row[3]);
        for place in -places..=places {
            let offset = f64::from(place) * 1e-3;
            let lower_side = z - (radius * radius - offset * offset).sqrt();
            deepest = deepest.max(profile(x + offset) - lower_side);
        }
    }
    deepest
}

/// The section's closing less the section, at places `step` apart with 0 ≤ ρ ≤ `rim`: the nose is put
/// down at every place, and the lowest kept. The contact lies within `reach` of the nose's X.
fn closing(theta: f64, radius: f64, reach: f64, rim: f64, step: f64) -> Vec<(f64, f64)> {
    let (arm, inside) = ((reach / step).ceil() as i64, (rim / step).floor() as i64);
    let profile = section(theta);
    let ends = -2 * arm..=inside + 2 * arm;
    let profile: Vec<f64> = ends.map(|i| profile(i as f64 * step)).collect();
    let lift: Vec<f64> = (-arm..=arm)
        .map(|i| (radius * radius - (i as f64 * step) * (i as f64 * step)).sqrt())
        .collect();
    let put = |around: &[f64]| {
        let highest = around.iter().zip(&lift).map(|(z, lift)| z + lift);
        highest.fold(f64::NEG_INFINITY, f64::max)
    };
    let centres: Vec<f64> = profile.windows(lift.len()).map(put).collect();
    let lowest = |around: &[f64]| {
        let lower = around.iter().zip(&lift).map(|(z, lift)| z - lift);
        lower.fold(f64::INFINITY, f64::min)
    };
    let surface = &profile[2 * arm as usize..];
    let closed = centres.windows(lift.len()).map(lowest).zip(surface);
    (0..)
        .zip(closed)
        .map(|(i, (closed, surface))| (i as f64 * step, closed - surface))
        .collect()
}

/// Height and volume that the nose cannot reach on the lattice of radius 1 mm, by brute force. Turned
/// by 90 deg the lattice is itself, so sections of that angle are enough, from the axis outward. Steps of
/// X miss the lowest place over a seam by a part of the step, so the volume is extrapolated from two.
fn brute_force() -> (f64, f64) {
    /// Sections of 90 deg.
    const SECTIONS: usize = 45;
    let reach = 0.4;
    let volume = |step: f64| -> f64 {
        let section = |i: usize| -> f64 {
            let theta = FRAC_PI_2 * (i as f64 + 0.31) / SECTIONS as f64;
            let over = closing(theta, 3.0, reach, 1.0, step);
            over.iter().map(|(rho, over)| rho * over).sum()
        };
        (0..SECTIONS).map(section).sum::<f64>() * step * TAU / SECTIONS as f64
    };
    // The deepest hollows lie on the diagonals, 0.707 mm from the axis.
    let diagonal = closing(45.0 * DEG, 3.0, reach, 1.0, 1e-4);
    let highest = diagonal.iter().map(|(_, over)| *over);
    (
        highest.fold(0.0, f64::max),
        2.0 * volume(4e-4) - volume(8e-4),
    )
}

#[test]
fn a_nose_too_large_for_the_hollows_is_refused_unless_the_recipe_asks_for_what_fits() {
    let recipe = changed(LATTICE, "interference = \"cut-what-fits\"\n", "");
    let bench = Bench::with(&recipe);
    bench.line("run recipe.toml -o out").ends(2);
    bench.line("check recipe.toml").ends(2);
}

#[test]
fn the_lattice_is_cut_by_first_touch_and_its_unreached_volume_is_that_of_brute_force() {
    let bench = Bench::with(LATTICE);
    let said = bench.line("run recipe.toml -o out --format json");
    // Over seams cusps grow with the feed itself, and 25 um are too many for 500 nm.
    let said = said.ends(1);
    let found = summary(&said);
    assert_eq!(found["within"]["interpolation"], true);
    let deepest = deepest(&bench, 3.0, 0.5);
    assert!(deepest < 1e-7, "{deepest} mm deep");
    let (height, volume) = brute_force();
    for (pointer, expected) in [
        ("/unreached/height_um", height * 1e3),
        ("/unreached/volume_mm3", volume),
    ] {
        let here = number(&found, pointer);
        assert!(
            (here / expected - 1.0).abs() < 0.01,
            "{pointer} {here}, not {expected}"
        );
    }
    let area = number(&found, "/unreached/area_fraction");
    assert!(area > 0.0 && area < 0.1);
    let checked = bench.line("check recipe.toml --format json").ends(0);
    let (checked, verified) = (
        summary(&checked),
        summary(&bench.line("verify recipe.toml out/toolpath.csv --format json")),
    );
    assert_eq!(checked["unreached"], found["unreached"]);
    assert_eq!(verified["unreached"], found["unreached"]);
    let error = "/interpolation_error/max_nm";
    assert_eq!(number(&verified, error), number(&found, error));
}

#[test]
fn with_a_feed_that_suits_the_seams_all_tolerances_hold() {
    let bench = Bench::with(&changed(LATTICE, "\"25 um/rev\"", "\"12 um/rev\""));
    let found = summary(&bench.line("run recipe.toml -o out --format json").ends(0));
    // Two passes a feed apart over a seam with flanks of slope m: m·feed/2, and the flat cusp.
    let residual = number(&found, "/residual/max_nm");
    assert!(residual > 100.0 && residual < 500.0, "{residual} nm");
}

#[test]
fn where_the_edge_is_too_short_for_the_slope_its_ends_touch() {
    let tool = |interference: &str| {
        let lines = format!("nose_radius = \"1 mm\"\nincluded_angle = \"8 deg\"\n{interference}");
        with_table(LATTICE, "tool", &lines)
    };
    Bench::with(&tool(""))
        .line("run recipe.toml -o out")
        .ends(2);
    let bench = Bench::with(&tool("interference = \"cut-what-fits\""));
    let said = bench.line("run recipe.toml -o out --format json");
    assert_ne!(said.status, Some(2), "{said}");
    let found = summary(&said);
    assert_eq!(found["within"]["interpolation"], true);
    let deepest = deepest(&bench, 1.0, Scalar::sin(4.0 * DEG));
    assert!(deepest < 1e-7, "{deepest} mm deep");
    // The end of an edge at 4 deg cuts steps into a slope of up to 5.08 deg, and the edge falls off
    // within a feed of its end.
    let feed = 25e3;
    let step = feed * (TAU * 0.02 * 0.5f64.sqrt() - Scalar::tan(4.0 * DEG)) + feed * feed / 2e6;
    let residual = number(&found, "/residual/max_nm");
    assert!(
        residual > 0.98 * step && residual < 1.01 * step,
        "{residual} nm, {step} nm"
    );
    assert_eq!(number(&found, "/unreached/volume_mm3"), 0.0);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_every_feed_and_sampler_comes_to_an_end() {
    let recipe = with_table(LATTICE, "part", "aperture = \"1.6 mm\"");
    let recipe = changed(&recipe, "residual = \"500 nm\"", "residual = \"2 um\"");
    for (feed, sampler) in [("atpg", "atpg"), ("constant", "equal-angle")] {
        let recipe = with_table(&recipe, "feed", &format!("use = \"{feed}\""));
        let recipe = with_table(&recipe, "sampler", &format!("use = \"{sampler}\""));
        let bench = Bench::with(&recipe);
        let found = summary(&bench.line("run recipe.toml -o out --format json"));
        assert_eq!(found["within"]["interpolation"], true, "{found}");
        assert!(number(&found, "/control_points") < 1e5);
    }
}

/// A feed that a strategy finds by itself knows how the part bends at the contact and nothing of the
/// corner over a seam: without the host it leaves 2.5 times as much.
fn assert_a_feed_that_is_found_holds(aperture_mm: f64) {
    let recipe = changed(LATTICE, "residual = \"500 nm\"", "residual = \"100 nm\"");
    let recipe = with_table(&recipe, "part", &format!("aperture = \"{aperture_mm} mm\""));
    let bench = Bench::with(&with_table(&recipe, "feed", "use = \"constant\""));
    let said = bench.line("run recipe.toml -o out --format json").ends(0);
    let residual = number(&summary(&said), "/residual/max_nm");
    assert!(residual > 80.0 && residual < 100.1, "{residual} nm");
    // The recipe's own feed is not changed, and the run reports the residual that it leaves.
    let bench = Bench::with(&recipe);
    let found = summary(&bench.line("run recipe.toml -o out --format json").ends(1));
    let turns = 0.5 * aperture_mm / 0.025;
    assert!((number(&found, "/revolutions") - turns).abs() < 0.1);
}

#[test]
fn a_feed_that_is_found_holds_the_residual_beside_seams_too() {
    assert_a_feed_that_is_found_holds(1.2);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_feed_that_is_found_holds_the_residual_beside_all_seams_too() {
    assert_a_feed_that_is_found_holds(2.0);
}

#[test]
fn compensation_along_the_normal_cannot_cut_what_fits() {
    let bench = Bench::with(&changed(LATTICE, "z-direction", "normal"));
    let said = bench.line("run recipe.toml");
    assert_eq!(bench.files(), ["recipe.toml"]);
    insta::assert_snapshot!(bench.shown(&said));
}

#[test]
fn check_reports_what_the_nose_cannot_reach() {
    let bench = Bench::with(&with_table(LATTICE, "part", "aperture = \"1.6 mm\""));
    insta::assert_snapshot!(bench.line("check recipe.toml").ends(0).stdout);
}
