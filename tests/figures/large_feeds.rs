//! Whole runs with feeds of up to half of the nose radius: the turns follow the residual, and the
//! cusps as measured hold it and use it.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;

/// A part under a nose of 0.2 mm.
fn recipe(surface: &str, residual: &str, feed: &str) -> String {
    format!(
        "format = 1\nname = \"rough\"\n[part]\naperture = \"5 mm\"\n[surface]\n{surface}\n\
         [tool]\nnose_radius = \"0.2 mm\"\n[tolerance]\ninterpolation = \"1 um\"\n\
         residual = \"{residual}\"\n[spindle]\nspeed = \"100 rpm\"\n[path]\nlead = false\n\
         [feed]\nuse = \"{feed}\"\n[sampler]\nuse = \"atpg\"\n\
         [compensator]\nuse = \"z-direction\"\n[velocity]\nuse = \"analytic\"\n\
         [output]\ndata = []\n"
    )
}

fn run(surface: &str, residual: &str, feed: &str) -> Value {
    let bench = Bench::with(&recipe(surface, residual, feed));
    bench
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json()
}

fn number(value: &Value, key: &str) -> f64 {
    value.pointer(key).and_then(Value::as_f64).unwrap()
}

const FLAT: &str = "use = \"conic\"\nradius = \"1000 m\"";
const DOME: &str = "use = \"conic\"\nradius = \"-20 mm\"";
const BOWL: &str = "use = \"conic\"\nradius = \"20 mm\"";

/// 2·sqrt(2Rε − ε²) = 39.95 µm for R = 0.2 mm and ε = 1 µm. `check` counts the turns without the
/// ends, where the feed runs out.
#[test]
fn a_flat_part_has_the_feed_of_the_closed_form() {
    for (residual, expected) in [("1 um", 39.95e-3), ("10 um", 124.9e-3)] {
        let bench = Bench::with(&recipe(FLAT, residual, "constant"));
        let line = "check recipe.toml --format json --set path.overrun=none";
        let checked = bench.line(line).ends(0).json();
        let feed = 2.5 / number(&checked, "/expected/revolutions");
        assert!((feed / expected - 1.0).abs() < 1e-3, "{residual}: {feed}");
    }
}

#[test]
fn each_residual_has_its_own_turns_and_is_used() {
    for (surface, feeds) in [
        (DOME, ["constant", "ats"]),
        (BOWL, ["atpg", "fft-adaptive"]),
    ] {
        for feed in feeds {
            let mut turns = f64::INFINITY;
            for (residual, nm) in [("1 um", 1e3), ("2 um", 2e3), ("10 um", 1e4)] {
                let summary = run(surface, residual, feed);
                let what = format!("{feed}, {surface}, {residual}: {summary:#}");
                let fewer = number(&summary, "/revolutions");
                // Cusps go with the square of the feed: 1.41 and 2.24 times fewer turns, but for
                // the turns of the ends.
                assert!(fewer < 0.8 * turns, "{what}");
                turns = fewer;
                let used = number(&summary, "/residual/max_nm") / nm;
                assert!((0.97..=1.001).contains(&used), "{used}: {what}");
                assert_eq!(summary["feed_cap"]["binds"], false, "{what}");
            }
        }
    }
}

/// Half of the included angle, less the slope, is all that an edge reaches on a cone-like rim.
#[test]
fn where_the_feed_comes_near_to_the_reach_of_the_nose_the_report_says_so() {
    let narrow = recipe(BOWL, "50 um", "atpg").replace(
        "nose_radius = \"0.2 mm\"",
        "nose_radius = \"0.2 mm\"\nincluded_angle = \"40 deg\"",
    );
    let bench = Bench::with(&narrow);
    let said = bench.line("run recipe.toml -o out").ends(0);
    let line = "within a tenth of the largest feed of the nose";
    assert!(said.stdout.contains(line), "{said}");
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let cap = &summary["feed_cap"];
    assert_eq!(cap["binds"], true, "{cap}");
    // 2R sin(20°) at the axis, and less on the slope.
    let feed = number(cap, "/feed_um_per_rev");
    assert!((60.0..137.0).contains(&feed), "{cap}");
    assert!(number(cap, "/to_mm") > number(cap, "/from_mm"), "{cap}");
    assert!(number(&summary, "/residual/max_nm") < 3e4, "{summary:#}");
    let checked = bench.line("check recipe.toml --format json").ends(0).json();
    assert_eq!(checked["feed_cap"], *cap);
    // The paper's feed of contacts has the same cap.
    let paper = bench
        .line("check recipe.toml --set feed.residual=paper")
        .ends(0);
    assert!(paper.stdout.contains(line), "{paper}");
}

/// Waves whose hollows the nose fills to nine tenths. The law of `ats` begins at rest at the rim and
/// follows the angle. Turned by a part of a turn it leaves 35 um.
#[test]
fn a_law_that_follows_the_angle_keeps_its_angles_where_it_begins_at_rest() {
    for sampler in ["equal-angle", "atpg", "ats", "minimax"] {
        let waves = format!(
            "format = 1\nname = \"waves\"\n[part]\naperture = \"8 mm\"\n[surface]\n\
             use = \"sinusoidal-array\"\namplitude_x = \"0.2 mm\"\nfrequency_x = \"0.34 /mm\"\n\
             form = \"sum\"\n[tool]\nnose_radius = \"1 mm\"\n[tolerance]\ninterpolation = \"100 nm\"\n\
             residual = \"10 um\"\n[spindle]\nspeed = \"100 rpm\"\n[feed]\nuse = \"ats\"\n\
             [sampler]\nuse = \"{sampler}\"\n[compensator]\nuse = \"normal\"\n\
             [velocity]\nuse = \"analytic\"\n[output]\ndata = []\n"
        );
        let bench = Bench::with(&waves);
        let run = bench.line("run recipe.toml -o out --no-report --format json");
        let summary = run.ends(0).json();
        let used = number(&summary, "/residual/max_nm") / 1e4;
        assert!(
            (0.9..=1.001).contains(&used),
            "{sampler}, {used}: {summary:#}"
        );
    }
}
