//! Parts on which the surface is not there: the recipe is wrong, and no strategy is to blame.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::recipe::{saddle_with, with_table};

/// What `check` and `run` say of the saddle with another surface: both refuse it alike.
#[track_caller]
fn refused(surface: &str, more: &[(&str, &str)]) -> String {
    let mut recipe = saddle_with("surface", surface);
    for (table, lines) in more {
        recipe = with_table(&recipe, table, lines);
    }
    let bench = Bench::with(&recipe);
    let said = bench.line("run recipe.toml -o out").ends(2);
    assert!(!said.stderr.contains("built in"), "{surface}: {said}");
    assert!(!bench.path("out").exists());
    said.stderr.clone()
}

#[test]
fn a_formula_without_a_height_at_the_axis() {
    for z in [
        "mm*ln(x/mm)",
        "mm^2/rho",
        "mm*sin(rho/mm)/(rho/mm)",
        "mm*(rho/mm)^-0.5",
    ] {
        let said = refused(&format!("use = \"formula\"\nz = \"{z}\""), &[]);
        let place = "at x = 0.0000 mm, y = 0.0000 mm";
        assert!(said.contains(place), "{z}: {said}");
        assert!(!said.contains("smaller aperture"), "{z}: {said}");
    }
}

#[test]
fn heights_that_no_part_has() {
    let said = refused("use = \"even-asphere\"\ncoefficients = { 4 = 1e300 }", &[]);
    assert!(said.contains("the surface has a height of"), "{said}");
    assert!(said.contains("at x = 0.3125 mm, y = 0.0000 mm"), "{said}");
    // The formula has no value beside the axis either, and that is said first.
    let said = refused("use = \"formula\"\nz = \"mm^2/x\"", &[]);
    assert!(said.contains("a division by 0 at x = 0.0000 mm"), "{said}");
}

#[test]
fn conic_numbers_that_no_design_has() {
    for (surface, name) in [
        (
            "use = \"conic\"\nradius = \"20 mm\"\nconic = -1e300",
            "conic",
        ),
        (
            "use = \"even-asphere\"\nradius = \"20 mm\"\nconic = -2e9",
            "conic",
        ),
        (
            "use = \"biconic\"\nradius_x = \"20 mm\"\nconic_x = -1e30",
            "conic_x",
        ),
    ] {
        let said = refused(surface, &[]);
        assert!(said.contains(&format!("`{name}`")), "{surface}: {said}");
    }
    let most = "use = \"conic\"\nradius = \"1000 m\"\nconic = -1e9";
    let bench = Bench::with(&saddle_with("surface", most));
    bench.line("check recipe.toml").ends(0);
}

/// The whole is smooth, and a part of it is too large for a number.
#[test]
fn a_formula_whose_part_overflows_is_underlined() {
    let z = "nm/(1+exp(-300*(x-0.3333*mm)/mm))";
    for aperture in ["5 mm", "4 mm"] {
        let part = format!("aperture = \"{aperture}\"");
        let said = refused(
            &format!("use = \"formula\"\nz = \"{z}\""),
            &[("part", &part)],
        );
        let is_told = said.contains("no slope") || said.contains("no finite derivatives");
        assert!(is_told, "{aperture}: {said}");
        let line = said.lines().find(|line| line.contains("^^^")).unwrap();
        assert_eq!(
            line.matches('^').count(),
            "exp(-300*(x-0.3333*mm)/mm)".len(),
            "{said}"
        );
        assert!(!said.contains("smaller aperture"), "{said}");
    }
    let same = "0.5*nm*(1+tanh(-150*(x-0.3333*mm)/mm))";
    let bench = Bench::with(&saddle_with(
        "surface",
        &format!("use = \"formula\"\nz = \"{same}\""),
    ));
    bench.line("check recipe.toml").ends(0);
}

/// Walls that do not go out from the axis, by an angle and without one. The part ends at 2.5 mm.
#[test]
fn a_height_that_jumps_on_the_part() {
    for (z, jump) in [
        ("um*atan2(y - 0.5*mm, x - 1*mm)", "6.283e-3 mm"),
        ("um*atan2(x - 0.3*mm, y + 1*mm)", "6.283e-3 mm"),
        ("um*atan(mm/(x - 0.7*mm))", "3.142e-3 mm"),
        ("um*(x + 0.4*mm)/abs(x + 0.4*mm)", "2.000e-3 mm"),
        (
            "nm*max(x, 2*mm)/mm + 2*nm*abs(y - x - 0.2*mm)/(y - x - 0.2*mm)",
            "4.000e-6 mm",
        ),
    ] {
        let said = refused(&format!("use = \"formula\"\nz = \"{z}\""), &[]);
        let what = format!("the height jumps by {jump} at x = ");
        assert!(said.contains(&what), "{z}: {said}");
    }
    // The wall lies beyond the part, or is a steep slope, or a crease.
    for z in [
        "um*atan2(y - 0.5*mm, x + 4*mm)",
        "0.01*um*tanh(360*x/mm)",
        "-0.001*abs(x - 0.3*mm)",
    ] {
        let surface = format!("use = \"formula\"\nz = \"{z}\"");
        let bench = Bench::with(&saddle_with("surface", &surface));
        bench.line("check recipe.toml").ends(0);
    }
}

/// A map of zeros, 8 mm wide.
fn flat_map(middle: f64) -> String {
    format!("9 9 1 1 0 {middle} 0\n{}", "0.001 0 0 0\n".repeat(81))
}

#[test]
fn a_map_that_lies_beside_the_part() {
    let recipe = saddle_with("surface", "use = \"grid-sag\"\nfile = \"map.DAT\"");
    let bench = Bench::with(&recipe);
    bench.write("map.DAT", flat_map(100.0));
    for command in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(command).ends(2);
        // The last cell ends at 100 − 4.5 mm, and the part at 2.5 mm.
        let what = "the map lies beside the part: the nearest of its points that has a height is \
                    93.0000 mm away";
        assert!(said.stderr.contains(what), "{said}");
    }
    bench.write("map.DAT", flat_map(6.0));
    bench.line("check recipe.toml").ends(0);
}

/// The nose hangs on a sharp tip under `z-direction`: the path is not smooth, and the sampler cannot
/// help it. `normal` makes a path, and the report says that the cusps beside the tip are too high.
#[test]
fn a_sharp_tip_that_no_step_follows() {
    let surface = "use = \"odd-asphere\"\ncoefficients = { 1 = -0.01 }";
    for sampler in ["atpg", "minimax"] {
        let sampler = format!("use = \"{sampler}\"");
        let analytic = ("velocity", "use = \"analytic\"");
        let said = refused(surface, &[("sampler", &sampler), analytic]);
        assert!(said.contains("the tolerance needs steps of"), "{said}");
    }
    let recipe = saddle_with("surface", surface);
    let recipe = with_table(&recipe, "sampler", "use = \"atpg\"");
    let recipe = with_table(&recipe, "compensator", "use = \"normal\"");
    let bench = Bench::with(&recipe);
    let said = bench.line("run recipe.toml -o out").ends(1);
    assert!(said.stdout.contains("EXCEEDED"), "{said}");
    // Where the contact goes up to the tip, the passes beside it are as close as all others.
    let line = "run recipe.toml -o out --set path.overrun=\"contact\"";
    bench.line(line).ends(0);
}

/// A formula that has a value nowhere is refused with its place, by every command that asks for heights.
#[test]
fn a_formula_without_any_value() {
    let nowhere = "use = \"formula\"\nz = \"sqrt(-mm^2 - rho^2)\"";
    let sum = "use = \"conic\"\nradius = \"90 mm\"\n\n[[surface]]\n".to_owned() + nowhere;
    let alone = saddle_with("surface", nowhere);
    let sum = saddle_with("surface", &sum).replacen("[surface]", "[[surface]]", 1);
    for recipe in [alone, sum] {
        for compensator in ["normal", "z-direction", "none"] {
            let compensator = format!("use = \"{compensator}\"");
            let bench = Bench::with(&with_table(&recipe, "compensator", &compensator));
            for command in ["check recipe.toml", "run recipe.toml -o out"] {
                let said = bench.line(command).ends(2);
                assert!(
                    said.stderr
                        .contains("the root of a negative number at x = 0.0000 mm")
                );
                assert!(said.stderr.contains("^ `z`"), "{said}");
            }
            let said = bench.line("sag recipe.toml --grid 5 -o sag.csv").ends(2);
            let place = "the surface has no height at x = 0.0000 mm, y = -2.5000 mm";
            assert!(said.stderr.contains(place), "{said}");
        }
    }
}

#[test]
fn the_points_of_sag_on_the_part_have_heights() {
    let recipe = saddle_with("surface", "use = \"conic\"\nradius = \"2 mm\"");
    let bench = Bench::with(&recipe);
    let said = bench.line("sag recipe.toml --grid 11 -o sag.csv").ends(2);
    let place = "the surface has no height at x = 0.0000 mm, y = -2.5000 mm";
    assert!(said.stderr.contains(place), "{said}");
    assert!(!bench.path("sag.csv").exists());
}
