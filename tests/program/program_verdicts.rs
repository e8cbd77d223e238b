//! What a run says of its programs, and what `verify` says of their files: the same.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, with_table};

/// A run that ends with this status, and the report of its program.
fn program_of(recipe: &str, status: i32) -> (Bench, Value) {
    let bench = Bench::with(recipe);
    let said = bench
        .line("run recipe.toml -o out --format json")
        .ends(status);
    let program = said.json()["programs"][0].clone();
    (bench, program)
}

/// `verify` finds on the file what the run found on the program, and has the same verdict.
#[track_caller]
fn agrees(bench: &Bench, file: &str, status: i32, pairs: &[(&Value, &str)]) {
    let said = bench.line(&format!("verify recipe.toml out/{file} --format json"));
    let report = said.ends(status).json();
    for (figure, pointer) in pairs {
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        let [one, other] = [
            *figure,
            &report.pointer(pointer).cloned().unwrap_or_default(),
        ]
        .map(number);
        assert!(
            (one - other).abs() <= 1e-9 * other.abs(),
            "{pointer}: {one} {other}"
        );
    }
}

/// Four decimals move passes by 50 nm.
#[test]
fn coarse_digits_move_passes_and_the_run_says_so() {
    let sphere = with_table(SADDLE, "surface", "use = \"conic\"\nradius = \"20 mm\"");
    let sphere = changed(&sphere, "aperture = \"5 mm\"", "aperture = \"2 mm\"");
    let sphere = changed(
        &sphere,
        "nose_radius = \"1 mm\"",
        "nose_radius = \"0.1 mm\"",
    );
    let sphere = changed(&sphere, "residual = \"100 nm\"", "residual = \"20 nm\"");
    let post = "[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\nposition_decimals = 4\n";
    let (bench, program) = program_of(&format!("{sphere}\n{post}"), 1);
    assert_eq!(program["within_residual"], false);
    let figures = [(&program["residual"]["max_nm"], "/residual/max_nm")];
    agrees(&bench, "recipe.pmc", 1, &figures);
    let said = bench.line("run recipe.toml -o out").ends(1);
    assert!(said.stdout.contains("more `position_decimals`"), "{said}");
    // Seven decimals are those of the path.
    let fine = "run recipe.toml -o fine --format json --set output.pmac-pvt.position_decimals=7";
    let program = bench.line(fine).ends(0).json()["programs"][0].clone();
    assert!(program.get("residual").is_none(), "{program}");
}

/// Velocities in whole mm/s move passes where X moves within the turn.
#[test]
fn coarse_velocities_move_passes_and_the_run_says_so() {
    let moved = changed(SADDLE, "use = \"z-direction\"", "use = \"normal\"");
    let moved = changed(
        &moved,
        "interpolation = \"100 nm\"",
        "interpolation = \"500 nm\"",
    );
    let post = "[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\nvelocity_decimals = 0\n";
    let (bench, program) = program_of(&format!("{moved}\n{post}"), 1);
    assert_eq!(program["within_interpolation"], true);
    assert_eq!(program["within_residual"], false);
    let figures = [(&program["residual"]["max_nm"], "/residual/max_nm")];
    agrees(&bench, "recipe.pmc", 1, &figures);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["within"]["residual"], true);
    let said = bench.line("run recipe.toml -o out").ends(1);
    assert!(
        said.stdout.contains("or more `velocity_decimals`"),
        "{said}"
    );
    let fine = "run recipe.toml -o fine --format json --set output.pmac-pvt.velocity_decimals=6";
    let program = bench.line(fine).ends(0).json()["programs"][0].clone();
    assert!(program.get("residual").is_none(), "{program}");
}

/// Servos follow straight lines less well than the cubics that these stand for.
#[test]
fn servos_are_judged_on_straight_lines() {
    let slow = changed(SADDLE, "k = \"0.08 /mm\"", "k = \"0.01 /mm\"");
    let slow = changed(&slow, "speed = \"500 rpm\"", "speed = \"100 rpm\"");
    let residual = "residual = \"100 nm\"";
    let slow = changed(&slow, residual, "residual = \"100 nm\"\nservo = \"20 nm\"");
    let servo = "[servo]\nbandwidth = \"100 Hz\"\n\n[output]\nposts = [\"beckhoff-g93\"]\n";
    let (bench, program) = program_of(&format!("{slow}\n{servo}"), 1);
    assert_eq!(program["within_servo"], false);
    let figures = [
        (&program["servo_error_nm"], "/servo/predicted_error/max_nm"),
        (
            &program["interpolation_error_nm"],
            "/interpolation_error/max_nm",
        ),
    ];
    agrees(&bench, "recipe.cnc", 1, &figures);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    assert_eq!(summary["within"]["servo"], true);
    assert_eq!(summary["within"]["programs"], false);
    let said = bench.line("run recipe.toml -o out").ends(1);
    let of_program = said.stdout.lines().find(|line| line.contains("EXCEEDED"));
    assert!(
        of_program.is_some_and(|line| line.ends_with("servo")),
        "{said}"
    );
}
