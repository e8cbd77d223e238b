//! The sizes and the points that `check` says, held against what `run` writes.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed, saddle_with};

/// By which part of a size `check` may be wrong.
const PART: f64 = 0.05;

const OUTPUT: &str = r#"
[output]
posts = ["pmac-pvt", "power-pmac-pvt", "automation1-pvt", "siemens-840d-poly", "beckhoff-poly"]
"#;

/// Programs of straight lines: several for each segment of the path.
const LINES: &str = r#"
[output]
posts = ["nanotech-g93", "linuxcnc-g93"]
nanotech-g93.f_means = "1/min"

[output.linuxcnc-g93]
servo_period = "0.1 ms"
"#;

/// The same five programs with other digits, and distances in place of positions.
const SHORT: &str = r#"
[output]
posts = ["pmac-pvt", "power-pmac-pvt", "automation1-pvt", "siemens-840d-poly", "beckhoff-poly"]

[output.pmac-pvt]
position_decimals = 6
c_wrap = "0-360"

[output.power-pmac-pvt]
positioning = "incremental"
velocity_per = "min"

[output.automation1-pvt]
velocity_decimals = 4
positioning = "incremental"

[output.siemens-840d-poly]
position_decimals = 9

[output.beckhoff-poly]
position_decimals = 5
time_axis_speed = "123.456 mm/s"
"#;

#[track_caller]
fn sizes_are_right(recipe: &str, output: &str) {
    let bench = Bench::with(&format!("{recipe}{output}"));
    let said = bench.line("check recipe.toml --format json").ends(0);
    let expected = &said.json()["expected"];
    let said = bench.line("run recipe.toml -o out");
    assert!(matches!(said.status, Some(0 | 1)), "{said}");
    let is_right = |file: &str, bytes: &Value| {
        let written = std::fs::metadata(bench.path(format!("out/{file}")))
            .unwrap()
            .len() as f64;
        let bytes = bytes.as_f64().unwrap();
        let part = bytes / written - 1.0;
        assert!(part.abs() < PART, "{file}: {bytes} of {written}, {part:.3}");
    };
    is_right("toolpath.csv", &expected["toolpath_bytes"]);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let points = |json: &Value| json["control_points"].as_f64().unwrap();
    let part = points(expected) / points(&summary) - 1.0;
    assert!(part.abs() < PART, "points: {part:.3}");
    let programs = expected["programs"].as_array().unwrap();
    let posts = output.lines().find(|line| line.starts_with("posts = "));
    assert_eq!(
        Some(programs.len()),
        posts.map(|posts| posts.split(", ").count())
    );
    for program in programs {
        is_right(program["file"].as_str().unwrap(), &program["bytes"]);
    }
}

fn with_leads(recipe: &str) -> String {
    changed(recipe, "lead = false", "lead = true")
}

#[test]
fn the_sizes_of_an_even_path_are_right() {
    sizes_are_right(SADDLE, OUTPUT);
    sizes_are_right(SADDLE, SHORT);
    sizes_are_right(SADDLE, LINES);
}

#[test]
fn the_sizes_of_a_path_with_leads_are_right() {
    sizes_are_right(&with_leads(SADDLE), OUTPUT);
    sizes_are_right(&with_leads(SADDLE), LINES);
}

#[test]
fn the_sizes_of_a_path_that_refinement_makes_longer_are_right() {
    let coarse = saddle_with("sampler", "use = \"equal-angle\"\nstep = \"40 deg\"");
    sizes_are_right(&with_leads(&coarse), OUTPUT);
}

#[test]
fn the_sizes_of_a_path_with_uneven_steps_are_right() {
    let uneven = saddle_with("sampler", "use = \"atpg\"");
    let uneven = changed(&uneven, "residual = \"100 nm\"", "residual = \"10 nm\"");
    sizes_are_right(&with_leads(&uneven), OUTPUT);
    sizes_are_right(&with_leads(&uneven), SHORT);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_sizes_of_the_recipes_of_the_documentation_are_right() {
    for name in [
        "astigmatic-5mm",
        "conic-50mm",
        "toric-40mm",
        "xy-polynomial-20mm",
        "sinusoidal-array-10mm",
        "surfaces/lenslet-array",
        "surfaces/forbes-q2d",
    ] {
        let file = format!("{}/../docs/recipes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let recipe = std::fs::read_to_string(file).unwrap();
        let own = recipe.split("\n[output").next().unwrap();
        // More turns than the documented range of TwinCAT has.
        let far = format!("{OUTPUT}beckhoff-poly.c_limit = \"1e7 deg\"\n");
        sizes_are_right(&format!("{own}\n"), &far);
    }
}

/// A part whose steps come out uneven at the borders of a sample.
const SLOW_SADDLE: &str = r#"format = 1
name = "Slow saddle"
part.aperture = "2 mm"
surface = { use = "astigmatic", k = "0.02 /mm" }
tool.nose_radius = "1 mm"
tolerance = { interpolation = "200 nm", residual = "1 um" }
spindle.speed = "60 rpm"
feed.use = "atpg"
sampler.use = "atpg"
compensator.use = "z-direction"
velocity.use = "triangle-rotary"
"#;

/// The border of a block of the sample cuts its last step off. The path has no step that short.
#[test]
fn a_border_of_the_sample_is_no_short_line_of_the_path() {
    for output in [
        r#"posts = ["pmac-pvt"], pmac-pvt.shortest_segment = "3 ms""#,
        r#"posts = ["siemens-840d-poly"], siemens-840d-poly.shortest_segment = "8 ms""#,
        r#"posts = ["linuxcnc-g93"], linuxcnc-g93.lowest_rate = "0 mm/min""#,
    ] {
        let bench = Bench::with(&format!("{SLOW_SADDLE}output = {{ {output} }}\n"));
        bench.line("check recipe.toml").ends(0);
        bench.line("run recipe.toml -o out --no-report").ends(0);
    }
}

/// 0.6 mm at 30 um a turn are 20 turns and a rounding: no block of its own, and no step.
#[test]
fn a_rounding_behind_whole_turns_is_no_block() {
    let slow = changed(
        SLOW_SADDLE,
        "sampler.use = \"atpg\"",
        "sampler.use = \"minimax\"",
    );
    let even = changed(
        &slow,
        "feed.use = \"atpg\"",
        "feed = { use = \"constant\", feed = \"30 um/rev\" }",
    );
    let exact = changed(&even, "triangle-rotary", "analytic");
    let recipe = changed(&exact, "aperture = \"2 mm\"", "aperture = \"1 mm\"");
    let path = "path = { direction = \"outward\", overrun = \"0.05 mm\" }\n";
    let bench = Bench::with(&format!("{recipe}{path}"));
    bench.line("check recipe.toml").ends(0);
    bench.line("run recipe.toml -o out --no-report").ends(0);
    // Behind 20 turns are 0.002 turns more: the end of the last block, which takes 2 ms.
    let equal = changed(&recipe, "minimax", "atpg");
    let output = "output = { posts = [\"pmac-pvt\"], pmac-pvt.shortest_segment = \"3 ms\" }\n";
    let bench = Bench::with(&format!("{equal}{path}{output}"));
    let longer = "--set path.overrun=0.05006mm";
    bench.line(&format!("check recipe.toml {longer}")).ends(0);
    bench
        .line(&format!("run recipe.toml -o out --no-report {longer}"))
        .ends(0);
}
