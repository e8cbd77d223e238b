//! Limits of a machine: the verdict on a run and on a file, and the highest spindle speed.

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{SADDLE, saddle_with};
use serde_json::Value;

/// Revolutions a minute of the saddle's spindle.
const RPM: f64 = 500.0;

fn run(bench: &Bench, sets: &str) -> Answer {
    bench.line(&format!("run recipe.toml -o out --format json {sets}"))
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

/// The unit of a figure in its key.
fn unit(axis: &str, what: &str) -> String {
    let angle_or_length = if axis == "c" { "deg" } else { "mm" };
    let time = match what {
        "velocity" => "s",
        "acceleration" => "s2",
        _ => "s3",
    };
    format!("{angle_or_length}_per_{time}")
}

/// The saddle with a limit a part of what its path takes.
fn limit(summary: &Value, axis: &str, what: &str, part: f64) -> String {
    let unit = unit(axis, what);
    let taken = number(summary, &format!("/axes/{axis}/max_{what}_{unit}"));
    let unit = match (axis, what) {
        ("c", "velocity") => return format!("--set machine.c_velocity={}rpm", part * taken / 6.0),
        (_, "velocity") => "mm/s",
        (_, "acceleration") => "mm/s^2",
        _ => "mm/s^3",
    };
    format!("--set machine.{axis}_{what}={}{unit}", part * taken)
}

#[test]
fn without_limits_there_is_no_verdict() {
    let summary = run(&Bench::with(SADDLE), "").ends(0).json();
    assert_eq!(summary["within"]["machine"], Value::Null);
    assert_eq!(summary["machine"], Value::Null);
    assert_eq!(summary["highest_spindle"]["speed_rpm"], Value::Null);
    assert_eq!(summary["highest_spindle"]["bound_by"], Value::Null);
}

/// z = k ρ² sin 2θ at the rim: 2ω·k·a² and 4ω²·k·a² on the surface, where the path begins.
#[test]
fn the_largest_rates_are_reported_with_their_places() {
    let bench = Bench::with(&saddle_with("compensator", "use = \"none\""));
    let summary = run(&bench, "").ends(0).json();
    let omega = RPM / 60.0 * std::f64::consts::TAU;
    let close = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 0.02, "{found}, {expected}");
    };
    let z = &summary["axes"]["z"];
    close(number(z, "/max_velocity_mm_per_s"), 2.0 * omega * 0.5);
    close(
        number(z, "/max_acceleration_mm_per_s2"),
        4.0 * omega * omega * 0.5,
    );
    for what in ["velocity", "acceleration", "jerk"] {
        let at = &z["at"][format!("max_{what}")];
        assert!(number(at, "/x_mm") > 2.47, "{z}");
        assert!(number(at, "/c_deg") < 360.0, "{z}");
    }
    close(
        number(z, "/rms_velocity_mm_per_s"),
        omega * 0.5 * (2.0f64 / 5.0).sqrt(),
    );
}

/// Compensation along the normal moves X to and fro. With a constant feed alone its acceleration is that of last bits,
/// which exceed no limit.
#[test]
fn each_limit_decides_for_itself() {
    let bench = Bench::with(&saddle_with("compensator", "use = \"normal\""));
    let free = run(&bench, "").ends(0).json();
    for axis in ["x", "z"] {
        for what in ["velocity", "acceleration", "jerk"] {
            let above = run(&bench, &limit(&free, axis, what, 1.01)).ends(0).json();
            assert_eq!(above["within"]["machine"], true);
            assert_eq!(above["control_points"], free["control_points"]);
            let below = run(&bench, &limit(&free, axis, what, 0.99)).ends(1).json();
            assert_eq!(below["within"]["machine"], false);
            assert_eq!(below["within"]["interpolation"], true);
            let reported = &below["machine"]["limits"][0];
            assert_eq!(reported["limit"], format!("{axis}_{what}"));
            assert_eq!(reported["holds"], false);
            assert_eq!(
                reported["at"],
                below["axes"][axis]["at"][format!("max_{what}")]
            );
        }
    }
}

/// With the feed `constant` the speed changes nothing but time. (A law of `atpg` may be another
/// one: it is smoothed until X keeps to its limit.)
#[test]
fn at_the_highest_spindle_speed_the_limits_hold_and_a_hundredth_above_they_do_not() {
    let bench = Bench::with(SADDLE);
    let free = run(&bench, "").ends(0).json();
    for (axis, what, part) in [
        ("z", "velocity", 0.4),
        ("z", "acceleration", 0.5),
        ("z", "jerk", 3.0),
        ("x", "velocity", 0.7),
        ("c", "velocity", 1.3),
    ] {
        let limits = limit(&free, axis, what, part);
        let status = i32::from(part < 1.0);
        let found = run(&bench, &limits).ends(status).json();
        assert_eq!(
            found["highest_spindle"]["bound_by"],
            format!("{axis}_{what}")
        );
        let highest = number(&found, "/highest_spindle/speed_rpm");
        let at = |rpm: f64| run(&bench, &format!("{limits} --set spindle.speed={rpm}rpm"));
        let just_below = at(0.99 * highest).ends(0).json();
        assert_eq!(just_below["within"]["machine"], true);
        let again = number(&just_below, "/highest_spindle/speed_rpm");
        assert!((again / highest - 1.0).abs() < 1e-6, "{again}, {highest}");
        if axis == "c" {
            let said = at(1.01 * highest).ends(2);
            assert!(said.stderr.contains("the limit `c_velocity`"), "{said}");
        } else {
            let above = at(1.01 * highest).ends(1).json();
            assert_eq!(above["within"]["machine"], false);
        }
    }
}

#[test]
fn of_several_limits_the_tightest_binds() {
    let bench = Bench::with(SADDLE);
    let free = run(&bench, "").ends(0).json();
    // 0.8 of the speed, 0.7 of its square, 0.6 of its cube.
    let limits = [("velocity", 0.8), ("acceleration", 0.7), ("jerk", 0.6)]
        .map(|(what, part)| limit(&free, "z", what, part));
    let found = run(&bench, &limits.join(" ")).ends(1).json();
    assert_eq!(found["highest_spindle"]["bound_by"], "z_velocity");
    let highest = number(&found, "/highest_spindle/speed_rpm");
    assert!((highest / (0.8 * RPM) - 1.0).abs() < 1e-9, "{highest}");
}

#[test]
fn a_file_is_held_against_the_machine_as_its_run_was() {
    let bench = Bench::with(SADDLE);
    let limits = "--set machine.preset=precitech-sts --set machine.x_velocity=1mm/s";
    let made = run(&bench, limits).ends(1).json();
    let words = format!("verify recipe.toml out/toolpath.csv --format json {limits}");
    let verified = bench.line(&words).ends(1).json();
    assert_eq!(verified["within"]["machine"], made["within"]["machine"]);
    let same = |pointer: &str| {
        let (one, other) = (number(&made, pointer), number(&verified, pointer));
        assert!(
            (one / other - 1.0).abs() < 1e-9,
            "{pointer}: {one}, {other}"
        );
    };
    same("/highest_spindle/speed_rpm");
    for i in 0..4 {
        let key = made["machine"]["limits"][i]["limit"].as_str().unwrap();
        let (axis, what) = key.split_once('_').unwrap();
        let unit = unit(axis, what);
        same(&format!("/machine/limits/{i}/limit_{unit}"));
        same(&format!("/machine/limits/{i}/measured_{unit}"));
        same(&format!("/machine/limits/{i}/at/x_mm"));
        let holds = format!("/machine/limits/{i}/holds");
        assert_eq!(made.pointer(&holds), verified.pointer(&holds));
    }
    assert_eq!(made["machine"]["preset"], "precitech-sts");
    assert!(
        made["machine"]["source"]
            .as_str()
            .unwrap()
            .contains("Precitech")
    );
}

#[test]
fn straight_segments_have_no_jerk_to_hold() {
    let bench = Bench::with(&saddle_with("velocity", "use = \"linear\""));
    let limits = "--set refine=false --set tolerance.interpolation=1mm";
    let jerk = format!("{limits} --set machine.z_jerk=1mm/s^3");
    let found = run(&bench, &jerk).ends(0).json();
    assert_eq!(found["within"]["machine"], Value::Null);
    assert_eq!(found["machine"]["limits"][0]["holds"], Value::Null);
    let both = format!("{jerk} --set machine.z_acceleration=1mm/s^2");
    assert_eq!(
        run(&bench, &both).ends(1).json()["within"]["machine"],
        false
    );
}

/// The lines of a call about the machine.
fn lines(said: &Answer) -> String {
    let of_machine = |line: &&str| {
        let words = [
            "machine",
            "spindle",
            " velocity",
            " acceleration",
            " jerk",
            "source:",
        ];
        words.iter().any(|word| line.contains(word)) && !line.contains("chain")
    };
    said.stdout
        .lines()
        .filter(of_machine)
        .map(|line| format!("{line}\n"))
        .collect()
}

#[test]
fn the_text_reports_which_limits_do_not_hold_and_where() {
    let bench = Bench::with(SADDLE);
    let limits = "--set machine.preset=generic-sts --set machine.x_acceleration=1g";
    let said = bench
        .line(&format!("run recipe.toml -o out {limits}"))
        .ends(1);
    insta::assert_snapshot!("exceeded", lines(&said));
    let slow = format!("run recipe.toml -o out {limits} --set spindle.speed=100rpm");
    insta::assert_snapshot!("all_hold", lines(&bench.line(&slow).ends(0)));
}

#[test]
fn check_reports_the_machine_and_its_source() {
    let bench = Bench::with(SADDLE);
    let limits = "--set machine.preset=precitech-sts --set machine.c_velocity=1000rpm";
    let said = bench.line(&format!("check recipe.toml {limits}")).ends(0);
    insta::assert_snapshot!("checked", lines(&said));
    let json = bench.line(&format!("check recipe.toml --format json {limits}"));
    let machine = &json.ends(0).json()["machine"];
    assert_eq!(machine["preset"], "precitech-sts");
    assert_eq!(machine["own_limits"], true);
    assert_eq!(machine["limits"][3]["limit"], "c_velocity");
    let without = bench.line("check recipe.toml --format json").ends(0).json();
    assert_eq!(without["machine"], Value::Null);
}
