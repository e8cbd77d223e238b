//! Remarks on what is allowed but seldom meant: one line each, and no other status.

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};

/// The remarks of a call in JSON, and the number of their lines in text.
#[track_caller]
fn remarks(words: &str) -> (Vec<String>, usize) {
    let bench = Bench::with(SADDLE);
    let text = bench.line(words).ends(0);
    let json = bench.line(&format!("{words} --format json")).ends(0).json();
    let kinds = json["remarks"].as_array().cloned().unwrap_or_default();
    let kinds = kinds.iter().map(|remark| remark["kind"].to_string());
    let lines = text.stdout.lines();
    let lines = lines.filter(|line| line.trim_start().starts_with("remark "));
    (kinds.collect(), lines.count())
}

#[track_caller]
fn has(words: &str, kind: &str) {
    let (kinds, lines) = remarks(words);
    assert_eq!(kinds.len(), lines, "{words}: {kinds:?}");
    assert!(kinds.contains(&format!("\"{kind}\"")), "{words}: {kinds:?}");
}

#[test]
fn a_usual_recipe_has_none() {
    assert_eq!(remarks("check recipe.toml"), (Vec::new(), 0));
}

#[test]
fn a_residual_and_an_aperture_of_ten_micrometres_have_one_each() {
    has(
        "check recipe.toml --set tolerance.residual=10um",
        "rough_residual",
    );
    has(
        "check recipe.toml --set part.aperture=10um",
        "small_aperture",
    );
}

#[test]
fn a_cut_of_a_night_has_one() {
    has("check recipe.toml --set spindle.speed=0.1rpm", "long_cut");
}

#[test]
fn digits_that_cannot_hold_the_tolerance_have_one_that_names_them() {
    let program = "check recipe.toml --set output.posts=[\"pmac-pvt\"] --set output.pmac-pvt";
    let positions =
        format!("{program}.position_decimals=4 --set output.pmac-pvt.velocity_decimals=7");
    assert_eq!(remarks(&positions), (vec!["\"coarse_digits\"".into()], 1));
    let velocities = format!("{program}.velocity_decimals=1");
    assert_eq!(
        remarks(&velocities),
        (vec!["\"coarse_velocity_digits\"".into()], 1)
    );
    // Left out, those of velocities follow those of positions, and cost far less.
    let both = format!("{program}.position_decimals=5");
    assert_eq!(remarks(&both), (vec!["\"coarse_digits\"".into()], 1));
}

/// The first division of a form of 1.4 um has a residual below 1 um. The saddle's path leaves a part
/// of it, so the run ends with a larger one.
#[test]
fn remarks_on_a_form_are_on_the_division_that_the_path_was_made_for() {
    let tolerances = "interpolation = \"100 nm\"\nresidual = \"100 nm\"";
    let bench = Bench::with(&changed(SADDLE, tolerances, "form = \"1.4 um\""));
    let residual_of = |words: &str| {
        let json = bench.line(&format!("{words} --format json")).ends(0).json();
        let all = json["remarks"].as_array().cloned().unwrap_or_default();
        let rough = all.iter().find(|one| one["kind"] == "rough_residual");
        let remarked = rough.map(|one| one["residual_nm"].as_f64());
        (remarked, json)
    };
    let (first, _) = residual_of("check recipe.toml");
    assert_eq!(first, None);
    let (last, report) = residual_of("run recipe.toml -o out");
    let split = report["form"]["residual_nm"].as_f64();
    assert!(split.is_some_and(|split| split > 1000.0), "{split:?}");
    assert_eq!(last, Some(split));
}

/// The saddle at 2000 rpm takes far more than g of Z; a machine with a limit has a verdict instead.
#[test]
fn a_fast_z_has_one_unless_the_machine_has_a_limit() {
    let fast = "run recipe.toml -o out --set spindle.speed=2000rpm";
    has(fast, "fast_z");
    let bench = Bench::with(SADDLE);
    let limited = format!("{fast} --format json --set machine.z_acceleration=100g");
    let json = bench.line(&limited).ends(0).json();
    assert_eq!(json["remarks"], serde_json::json!([]));
}

/// A sphere that is 30° steep at its rim. On a flat, cusps of 20 nm of a nose of 0.5 mm end
/// acos(1 − 20 nm/0.5 mm) = 0.5125° beyond the contact: so 61.02° are enough, and less is not.
#[test]
fn an_edge_that_ends_before_passes_meet_has_one_with_the_angle_that_is_enough() {
    let sphere = with_table(SADDLE, "surface", "use = \"conic\"\nradius = \"5 mm\"");
    let sphere = changed(
        &sphere,
        "nose_radius = \"1 mm\"",
        "nose_radius = \"0.5 mm\"",
    );
    let sphere = changed(&sphere, "residual = \"100 nm\"", "residual = \"20 nm\"");
    let sphere = with_table(&sphere, "feed", "use = \"atpg\"");
    let sphere = changed(&sphere, "overrun = \"none\"", "overrun = \"contact\"");
    let bench = Bench::with(&sphere);
    let of = |included_angle: &str, status: i32| {
        let change = format!("--set tool.included_angle={included_angle}deg --format json");
        let check = bench.line(&format!("check recipe.toml {change}")).ends(0);
        let run = bench.line(&format!("run recipe.toml -o out {change}"));
        [check, run.ends(status)].map(|said| said.json()["remarks"][0].clone())
    };
    for remark in of("60.2", 1) {
        assert_eq!(remark["kind"], "short_edge");
        let has = |key: &str, wanted: f64, within: f64| {
            let number = remark[key].as_f64();
            let is_near = number.is_some_and(|number| (number - wanted).abs() < within);
            assert!(is_near, "{key}: {remark}");
        };
        has("edge_deg", 0.1, 1e-3);
        has("meeting_deg", 0.5125, 0.03);
        has("included_angle_deg", 61.02, 0.06);
    }
    assert_eq!(
        of("61.1", 0),
        [serde_json::Value::Null, serde_json::Value::Null]
    );
}

/// At 2000 rpm a segment of 0.1 ms is more than a degree. Its error is far above a picometre.
#[test]
fn an_error_that_shorter_segments_would_lower_has_one_that_says_so() {
    let bench = Bench::with(SADDLE);
    let words = "run recipe.toml -o out --set spindle.speed=2000rpm \
                 --set tolerance.interpolation=0.001nm --set tolerance.residual=1um";
    let said = bench.line(words).ends(1);
    let wanted = "refinement makes none below 0.1 ms: turn the spindle slower";
    assert!(said.stdout.contains(wanted), "{said}");
    let kinds = |words: &str| {
        let json = bench.line(&format!("{words} --format json")).json();
        json["remarks"].to_string()
    };
    assert!(kinds(words).contains("shortest_segments"));
    // Without refinement nothing was to be halved.
    let words = format!("{words} --set refine=false");
    assert!(!kinds(&words).contains("shortest_segments"));
}
