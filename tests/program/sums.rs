//! Several surfaces in one recipe, and the pose of the part, as a person sees them.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Answer, Bench};
use crate::support::fixtures::{file_name, library};
use crate::support::recipe::{SADDLE, changed};
use serde_json::Value;

/// The saddle as a sum: twice as much, less the same again.
fn sum() -> String {
    let second = "[[surface]]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\nscale = 2\n\n\
                  [[surface]]\nuse = \"xy-polynomial\"\nterms = [[1, 1, 0.16]]\nscale = -1\n";
    let single = "[surface]\nuse = \"astigmatic\"\nk = \"0.08 /mm\"\n";
    changed(SADDLE, single, second)
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/summary.json")).unwrap()
}

fn run(bench: &Bench, rest: &str) -> Answer {
    bench.line(&format!("run recipe.toml -o out {rest}"))
}

#[test]
fn a_sum_is_the_surface_that_it_adds_up_to() {
    let (alone, sum) = (Bench::with(SADDLE), Bench::with(&sum()));
    run(&alone, "").ends(0);
    let said = run(&sum, "").ends(0);
    assert!(
        said.stdout
            .contains("astigmatic + xy-polynomial > constant"),
        "{said}"
    );
    assert_eq!(
        summary(&sum)["chain"]["surface"],
        "astigmatic + xy-polynomial"
    );
    let rows = |bench: &Bench| -> Vec<Vec<f64>> {
        let text = bench.read("out/toolpath.csv");
        let lines = text.lines().filter(|line| !line.starts_with(['#', 't']));
        let row = |line: &str| line.split(',').map(|one| one.parse().unwrap()).collect();
        lines.map(row).collect()
    };
    let (alone, sum) = (rows(&alone), rows(&sum));
    assert_eq!(alone.len(), sum.len());
    for (alone, sum) in alone.iter().zip(&sum) {
        for (alone, sum) in alone.iter().zip(sum) {
            assert!((alone - sum).abs() <= 1e-9 * alone.abs().max(1.0));
        }
    }
}

#[test]
fn a_list_of_one_and_a_place_that_changes_nothing_are_the_surface_itself() {
    let bytes = |recipe: &str| {
        let bench = Bench::with(recipe);
        run(&bench, "").ends(0);
        fs::read(bench.path("out/toolpath.csv")).unwrap()
    };
    let alone = bytes(SADDLE);
    let listed = changed(SADDLE, "[surface]", "[[surface]]");
    let place = "scale = 1\ndecentre_x = \"0 mm\"\nclocking = \"0 deg\"\npiston = \"0 nm\"\nk =";
    assert!(alone == bytes(&listed) && alone == bytes(&changed(&listed, "k =", place)));
}

#[test]
fn set_names_the_surface_that_it_changes() {
    let bench = Bench::with(&sum());
    let said = run(&bench, "--set surface.0.scale=1 --set surface.1.scale=-0.5");
    said.ends(0);
    // Half of the saddle is left.
    bench
        .line("sag recipe.toml --grid 2 -o sag.csv --set surface.0.scale=1 --set surface.1.scale=-0.5")
        .ends(0);
    let last = bench.read("sag.csv").lines().last().unwrap().to_owned();
    let z: f64 = last.split(',').nth(2).unwrap().parse().unwrap();
    assert!((z - 0.5).abs() < 1e-12, "{last}");
    let said = run(&bench, "--set surface.scale=1").ends(2);
    insta::assert_snapshot!("set_without_the_surface", bench.shown(&said));
}

#[test]
fn a_mistake_in_the_second_surface_is_underlined_there() {
    let bench = Bench::with(&changed(
        &sum(),
        "terms = [[1, 1, 0.16]]",
        "terms = [[1, 1]]",
    ));
    let said = run(&bench, "").ends(2);
    insta::assert_snapshot!("mistake_in_the_second_surface", bench.shown(&said));
    let bench = Bench::with(&changed(&sum(), "xy-polynomial", "xy-polynomal"));
    let said = run(&bench, "").ends(2);
    insta::assert_snapshot!("second_surface_unknown", bench.shown(&said));
    // The strategy itself refuses what it cannot work with.
    let twice = "terms = [[1, 1, 0.16], [1, 1, 0.2]]";
    let bench = Bench::with(&changed(&sum(), "terms = [[1, 1, 0.16]]", twice));
    let said = run(&bench, "").ends(2);
    insta::assert_snapshot!("second_surface_refuses", bench.shown(&said));
}

#[test]
fn a_surface_of_a_sum_that_panics_is_named_with_its_plugin() {
    let recipe = changed(
        &sum(),
        "use = \"xy-polynomial\"\nterms = [[1, 1, 0.16]]",
        "use = \"panicking-surface\"",
    );
    let posed = format!("{recipe}\n[part.pose]\nx = \"0.5 mm\"\nlevel = true\n");
    for recipe in [recipe, posed] {
        let bench = Bench::with(&recipe);
        fs::create_dir(bench.path("plugins")).unwrap();
        let copy = bench.path("plugins").join(file_name("panics"));
        fs::copy(library("panics"), copy).unwrap();
        let said = run(&bench, "--plugin-dir plugins").ends(3);
        assert!(said.stderr.contains("`panicking-surface`"), "{said}");
        assert!(said.stderr.contains(&file_name("panics")), "{said}");
        assert!(said.stderr.contains("the table ends"), "{said}");
        // The place is that of the surface, not of the first one.
        assert!(
            said.stderr.contains("| use = \"panicking-surface\""),
            "{said}"
        );
    }
}

/// Both surfaces have one strategy. The first lies where it does not panic.
#[test]
fn of_two_surfaces_with_one_strategy_the_one_that_fails_is_underlined() {
    let recipe = changed(
        &sum(),
        "use = \"xy-polynomial\"\nterms = [[1, 1, 0.16]]",
        "use = \"panicking-surface\"\ndecentre_x = \"100 mm\"\n\n\
         [[surface]]\nuse = \"panicking-surface\"",
    );
    let bench = Bench::with(&recipe);
    fs::create_dir(bench.path("plugins")).unwrap();
    let copy = bench.path("plugins").join(file_name("panics"));
    fs::copy(library("panics"), copy).unwrap();
    let said = run(&bench, "--plugin-dir plugins").ends(3);
    let uses = |line: &(usize, &str)| line.1 == "use = \"panicking-surface\"";
    let lines: Vec<usize> = (1..)
        .zip(recipe.lines())
        .filter(uses)
        .map(|line| line.0)
        .collect();
    assert_eq!(lines.len(), 2);
    let place = format!("--> recipe.toml:{}:", lines[1]);
    assert!(said.stderr.contains(&place), "{place}\n{said}");
}

#[test]
fn a_pose_where_the_part_cannot_lie_is_refused() {
    let sphere = "use = \"conic\"\nradius = \"40 mm\"\n";
    let recipe = changed(SADDLE, "use = \"astigmatic\"\nk = \"0.08 /mm\"\n", sphere);
    let pose = "[part.pose]\nx = \"50 mm\"\nlevel = true\n";
    let bench = Bench::with(&format!("{recipe}\n{pose}"));
    let said = run(&bench, "").ends(2);
    insta::assert_snapshot!("pose_beyond_the_surface", bench.shown(&said));
    let tilt = "--set part.pose.x=38mm --set part.pose.level=false --set part.pose.tilt_y=-60deg";
    let said = run(&bench, tilt).ends(2);
    insta::assert_snapshot!("pose_with_an_overhang", bench.shown(&said));
}

#[test]
fn the_surfaces_of_an_ablation_may_be_sums() {
    let lists = "[ablation]\nsurface = [[{ use = \"conic\", radius = \"100 mm\" }, \
                 { use = \"astigmatic\", k = \"0.01 /mm\" }]]\n";
    let bench = Bench::with(&format!("{}\n{lists}", sum()));
    let said = bench.line("ablate recipe.toml -o out").ends(0);
    // The table breaks a long name.
    for name in [
        "\nastigmatic + ",
        "\nxy-polynomial",
        "\nconic + astigmatic ",
    ] {
        assert!(said.stdout.contains(name), "{said}");
    }
    let all: Value = serde_json::from_str(&bench.read("out/ablation.json")).unwrap();
    let varied = &all["runs"][1]["varied"];
    assert_eq!(varied["surface"], "conic + astigmatic");
    let keys = "--set ablation={\"surface\"={\"0\"={scale=[2.5]}}}";
    let said = bench
        .line(&format!("ablate recipe.toml -o keys {keys}"))
        .ends(0);
    assert!(said.stdout.contains("surface.0.scale"), "{said}");
}
