//! What a real nose does along a path that takes its radius as 0, against closed forms.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::Value;

/// A hollow sphere of 20 mm under a nose of 1 mm.
fn bowl() -> String {
    let bowl = with_table(SADDLE, "surface", "use = \"conic\"\nradius = \"20 mm\"");
    let bowl = with_table(&bowl, "compensator", "use = \"none\"");
    changed(&bowl, "overrun = \"none\"", "overrun = \"contact\"")
}

fn number(of: &Value, pointer: &str) -> f64 {
    let found = of.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer}"))
}

/// With its lowest point at the contact of slope angle a, the nose's circle touches its envelope at
/// ρ + R sin a, R − R cos a above the contact.
fn gouge_at(rim: f64, sphere: f64, nose: f64) -> f64 {
    let rho = rim / (1.0 + nose / sphere);
    let depth = |rho: f64| (sphere * sphere - rho * rho).sqrt();
    depth(rho) - depth(rim) - nose * (1.0 - depth(rho) / sphere)
}

/// All tolerances hold, since they are those of a nose without a radius. The gouge of a real nose is
/// told in the summary, in the text, and by `verify`.
#[test]
fn a_path_without_compensation_tells_what_the_real_nose_gouges() {
    let bench = Bench::with(&bowl());
    let run = bench.call(["run", "recipe.toml", "-o", "out"]).ends(0);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).expect("JSON");
    // Both edges of the diameter gouge alike; within is the machined part.
    let known = gouge_at(2.5, 20.0, 1.0) * 1e6;
    let lowest = number(&summary, "/real_nose/lowest/error_nm");
    assert!(
        (-lowest / known - 1.0).abs() < 0.02,
        "{lowest}, not {known}"
    );
    let highest = number(&summary, "/real_nose/highest/error_nm");
    let pv = number(&summary, "/real_nose/pv_nm");
    assert!((pv - (highest - lowest)).abs() < 1e-6 * pv);
    // The path's own machined surface knows nothing of it.
    assert!(number(&summary, "/surface_error/pv_nm") < 0.1 * pv);
    let warning = "the path takes the nose radius as 0; the real nose gouges ";
    assert!(run.stdout.contains(warning), "{}", run.stdout);
    let verified = bench.call([
        "verify",
        "recipe.toml",
        "out/toolpath.csv",
        "--format",
        "json",
    ]);
    let verified = verified.ends(0).json();
    let again = number(&verified, "/real_nose/lowest/error_nm");
    assert!((again / lowest - 1.0).abs() < 1e-6, "{again}");
}

#[test]
fn a_path_with_compensation_has_no_other_real_nose() {
    let bench = Bench::with(&changed(&bowl(), "\"none\"", "\"z-direction\""));
    let run = bench.call(["run", "recipe.toml", "-o", "out"]).ends(0);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).expect("JSON");
    assert_eq!(summary["real_nose"], Value::Null);
    assert!(!run.stdout.contains("real nose"), "{}", run.stdout);
}
