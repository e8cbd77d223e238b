//! The servo model over whole programs: `[servo]` in a recipe, its figures in `run` and `verify`.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;
use serde_json::Value;

fn run(sets: &str) -> (Bench, Value) {
    let bench = Bench::with(SADDLE);
    let said = bench.line(&format!("run recipe.toml -o out --format json {sets}"));
    // The limits of the preset do not matter here.
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let summary = said.json();
    (bench, summary)
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap()
}

#[test]
fn without_the_table_there_is_no_figure() {
    assert_eq!(run("").1["servo"], Value::Null);
}

/// C turns evenly and lags by 2ζω/ω₀, whatever else moves.
#[test]
fn run_and_verify_report_the_same_and_hold_it_against_no_tolerance() {
    for lead in ["--set path.lead=false", "--set path.lead=true"] {
        let sets = format!("--set servo.bandwidth=70Hz {lead}");
        let (bench, summary) = run(&sets);
        let said = bench.line(&format!(
            "verify recipe.toml out/toolpath.csv --format json {sets}"
        ));
        let verified = said.ends(0).json();
        let late = 2.0 * 0.7 * (500.0 / 60.0) / 70.0 * 360.0 * 3600.0 / std::f64::consts::TAU;
        let c = number(&summary, "/servo/following_error/c/max_arcsec");
        assert!((c / late - 1.0).abs() < 1e-2, "{c}, {late}");
        for pointer in [
            "/servo/following_error/x/max_um",
            "/servo/following_error/z/rms_um",
            "/servo/following_error/c/max_arcsec",
            "/servo/predicted_error/max_nm",
            "/servo/predicted_error/rms_nm",
            "/servo/predicted_error/at/x_mm",
        ] {
            let (one, other) = (number(&summary, pointer), number(&verified, pointer));
            assert!(
                (one / other - 1.0).abs() < 1e-9,
                "{pointer}: {one}, {other}"
            );
        }
        let predicted = number(&summary, "/servo/predicted_error/max_nm");
        assert!(predicted > 1000.0, "{predicted} nm");
        assert_eq!(summary["within"]["interpolation"], true);
    }
}

/// A tolerance a little above the figure holds, one a little below does not, in run and verify.
#[test]
fn a_tolerance_of_the_servo_is_judged_by_the_predicted_error() {
    let sets = "--set servo.bandwidth=70Hz --set servo.velocity_feed_forward=1";
    let (bench, summary) = run(sets);
    assert_eq!(summary["within"]["servo"], Value::Null);
    let predicted = number(&summary, "/servo/predicted_error/max_nm");
    for (part, holds) in [(1.01, true), (0.99, false)] {
        let sets = format!("{sets} --set tolerance.servo={}nm", part * predicted);
        let (_, summary) = run(&sets);
        let verify = format!("verify recipe.toml out/toolpath.csv --format json {sets}");
        let said = bench.line(&verify).ends(i32::from(!holds));
        for of in [&summary, &said.json()] {
            assert_eq!(of["within"]["servo"], holds);
            assert!((number(of, "/tolerance/servo_nm") / (part * predicted) - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn axes_that_follow_wholly_leave_the_played_path() {
    let whole = "--set servo.bandwidth=70Hz --set servo.velocity_feed_forward=1 \
                 --set servo.acceleration_feed_forward=1";
    let (_, summary) = run(whole);
    let played = number(&summary, "/interpolation_error/rms_nm");
    let predicted = number(&summary, "/servo/predicted_error/rms_nm");
    assert!(
        (predicted / played - 1.0).abs() < 1e-6,
        "{predicted}, {played}"
    );
}

#[test]
fn a_preset_brings_the_bandwidth_of_its_servo() {
    let forward = "--set servo.velocity_feed_forward=1";
    let (_, preset) = run(&format!("{forward} --set machine.preset=precitech-sts"));
    let (_, given) = run(&format!("{forward} --set servo.bandwidth=70Hz"));
    assert_eq!(preset["servo"], given["servo"]);
    let (_, wide) = run(&format!("{forward} --set servo.bandwidth=700Hz"));
    let error = |summary: &Value| number(summary, "/servo/predicted_error/max_nm");
    assert!(error(&wide) < 0.05 * error(&given));
}

#[test]
fn the_text_reports_the_servo_in_two_lines() {
    let bench = Bench::with(SADDLE);
    let said = bench
        .line("run recipe.toml -o out --set servo.bandwidth=70Hz")
        .ends(0);
    assert!(said.stdout.contains("\n  servo  "), "{said}");
    assert!(said.stdout.contains(" arcsec in C\n"), "{said}");
}

#[test]
fn wrong_values_are_shown_at_their_place() {
    let bench = Bench::with(&format!("{SADDLE}\n[servo]\ndamping = 0.7\n"));
    let said = bench.line("check recipe.toml").ends(2);
    assert!(said.stderr.contains("[servo] lacks `bandwidth`"), "{said}");
    for (set, reported) in [
        (
            "servo.damping=0",
            "`damping` must be above 0 and at most 100",
        ),
        (
            "servo.damping=1e300",
            "`damping` must be above 0 and at most 100",
        ),
        (
            "servo.bandwidth=1e300Hz",
            "at least 0.001 Hz and at most 1000 kHz",
        ),
        (
            "servo.x_bandwidth=1e-300Hz",
            "at least 0.001 Hz and at most 1000 kHz",
        ),
        (
            "servo.c_bandwidth=0Hz",
            "at least 0.001 Hz and at most 1000 kHz",
        ),
        (
            "servo.z_delay=2s",
            "`z_delay` must be at least 0 s and at most 1 s",
        ),
        (
            "servo.velocity_feed_forward=1.2",
            "must be at least 0 and at most 1",
        ),
        ("servo.bandwith=70Hz", "did you mean `bandwidth`?"),
    ] {
        let words = format!("check recipe.toml --set servo.bandwidth=70Hz --set {set}");
        let said = bench.line(&words).ends(2);
        assert!(said.stderr.contains(reported), "{said}");
    }
}

/// Every figure is a number for all values that a recipe may have.
#[test]
fn at_the_ends_of_what_is_allowed_every_figure_is_a_number() {
    for bandwidth in ["0.001Hz", "1e6Hz"] {
        for damping in ["1e-300", "1", "100"] {
            let sets = format!("--set servo.bandwidth={bandwidth} --set servo.damping={damping}");
            let (_, summary) = run(&sets);
            let servo = serde_json::to_string(&summary["servo"]).unwrap();
            assert!(!servo.contains("null"), "{sets}: {servo}");
        }
    }
}
