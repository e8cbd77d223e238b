//! A lab's own strategies: written outside the repository against the plugin crate alone, loaded,
//! and used in a recipe whose tolerance holds all the same.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "helpers of tests may panic too"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::support::bench::Bench;
use crate::support::builds::{self, cargo, run, target_folder};
use crate::support::fixtures::{file_name, plugin_folder};
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};
use crate::support::repository;
use tempfile::TempDir;

/// The author's manifest: one dependency, and none of this repository's settings. It has no debug
/// information, like the build of the tests, so that most of their dependencies serve here too.
const MANIFEST: &str = r#"[package]
name = "lab-sampler"
version = "0.1.0"
edition = "2024"

[lib]
crate-type = ["cdylib"]

[dependencies]
turnpath-plugin = { path = "PLUGIN" }

[workspace]

[profile.dev]
debug = 0
"#;

/// Points far too sparse for the tolerance.
const SPARSE: &str = "use = \"constant-arc\"\nspacing = \"20 mm\"\nat_least = 4";

fn source() -> String {
    let file = repository().join("tests/fixtures/constant-arc/src/lib.rs");
    fs::read_to_string(file).expect("the sample")
}

/// The sample, built as a crate of its own in a folder outside the repository.
fn own_library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let home = tempfile::tempdir().expect("a temporary folder");
        let plugin = repository().join("crates/plugin");
        let plugin = plugin.to_str().expect("a path in UTF-8").replace('\\', "/");
        fs::create_dir(home.path().join("src")).expect("a folder");
        let manifest = home.path().join("Cargo.toml");
        fs::write(&manifest, MANIFEST.replace("PLUGIN", &plugin)).expect("a manifest");
        fs::write(home.path().join("src/lib.rs"), source()).expect("a source file");
        // The fixtures' versions, so that nothing is fetched.
        let lock = repository().join("tests/fixtures/Cargo.lock");
        fs::copy(lock, home.path().join("Cargo.lock")).expect("a lock file");
        let target = target_folder("fixtures");
        let mut build = cargo("build", &manifest, &target);
        build.env("CARGO_BUILD_BUILD_DIR", builds::target());
        run(build);
        target.join("debug").join(file_name("lab-sampler"))
    })
}

fn own_folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(own_library(), folder.path().join(file_name("lab-sampler"))).unwrap();
    folder
}

/// Runs the recipe with plugins of a folder; gives the summary.
fn run_with(bench: &Bench, folder: &TempDir, rest: &[&str]) -> serde_json::Value {
    let mut args = vec!["run", "recipe.toml", "-o", "out", "--format", "json"];
    args.extend(["--plugin-dir", folder.path().to_str().unwrap()]);
    args.extend(rest);
    bench.call(args).ends(0).json()
}

#[track_caller]
fn holds(summary: &serde_json::Value, tolerance_nm: f64) {
    assert_eq!(summary["within"]["interpolation"], true);
    assert_eq!(summary["within"]["residual"], true);
    let max = summary["interpolation_error"]["max_nm"].as_f64().unwrap();
    assert!(max <= 1.001 * tolerance_nm, "{max} nm");
}

#[test]
fn the_sample_is_short_and_has_no_unsafe_code() {
    let source = source();
    assert!(source.lines().count() <= 40, "{}", source.lines().count());
    assert!(source.contains("#![forbid(unsafe_code)]"));
}

#[test]
fn a_lab_s_sampler_is_listed_and_explained() {
    let folder = own_folder();
    let dir = folder.path().to_str().unwrap();
    let bench = Bench::empty();
    let list = bench.call(["list", "sampler", "--plugin-dir", dir]).ends(0);
    assert!(list.stdout.contains("constant-arc"), "{list}");
    assert!(list.stdout.contains("equal-angle"), "{list}");
    assert!(list.stdout.contains(&file_name("lab-sampler")), "{list}");
    let explained = bench.call(["explain", "constant-arc", "--plugin-dir", dir]);
    let text = explained.ends(0).stdout;
    let file = fs::canonicalize(dir).unwrap();
    let text = text.replace(file.to_str().unwrap(), "[folder]");
    insta::assert_snapshot!("constant_arc_explained", text);
}

#[test]
fn refinement_holds_the_tolerance_for_a_sampler_that_places_too_few_points() {
    let bench = Bench::with(&saddle_with("sampler", SPARSE));
    let summary = run_with(&bench, &own_folder(), &[]);
    holds(&summary, 100.0);
    let added = summary["points_added_by_refine"].as_u64().unwrap();
    let points = summary["control_points"].as_u64().unwrap();
    assert!(added > points / 2, "{added} of {points}");
    let verified = bench.call([
        "verify",
        "recipe.toml",
        "out/toolpath.csv",
        "--plugin-dir",
        own_folder().path().to_str().unwrap(),
    ]);
    verified.ends(0);
}

#[test]
fn without_refinement_the_same_sampler_misses_the_tolerance() {
    let recipe = saddle_with("sampler", SPARSE);
    let bench = Bench::with(&recipe);
    let folder = own_folder();
    let dir = folder.path().to_str().unwrap();
    let said = bench.call([
        "run",
        "recipe.toml",
        "--plugin-dir",
        dir,
        "--set",
        "refine=false",
    ]);
    let said = said.ends(1);
    assert!(said.stdout.contains("EXCEEDED"), "{said}");
}

#[test]
fn the_author_s_parameters_are_checked_like_those_of_a_built_in() {
    let bench = Bench::with(&saddle_with(
        "sampler",
        "use = \"constant-arc\"\nspacing = \"8 ms\"\nat_least = 2",
    ));
    let folder = own_folder();
    let dir = folder.path().to_str().unwrap();
    let said = bench.call(["check", "recipe.toml", "--plugin-dir", dir]);
    insta::assert_snapshot!("constant_arc_parameters", bench.shown(&said.ends(2)));
}

#[test]
fn plugins_that_a_recipe_lists_are_loaded_when_it_is_trusted() {
    let recipe = saddle_with("sampler", SPARSE);
    for listed in ["labs", "labs/liblab_sampler.so"] {
        let plugins = format!("format = 1\nplugins = [\"{listed}\"]\n");
        let bench = Bench::with(&changed(&recipe, "format = 1\n", &plugins));
        fs::create_dir(bench.path("labs")).unwrap();
        fs::copy(own_library(), bench.path("labs/liblab_sampler.so")).unwrap();
        let said = bench.line("run recipe.toml --trust-recipe --format json");
        holds(&said.ends(0).json(), 100.0);
    }
}

#[test]
fn plugins_that_a_recipe_lists_are_not_loaded_without_trust() {
    let recipe = changed(SADDLE, "format = 1\n", "format = 1\nplugins = [\"labs\"]\n");
    let bench = Bench::with(&recipe);
    for command in ["run recipe.toml", "check recipe.toml"] {
        let said = bench.line(command).ends(2);
        insta::assert_snapshot!("recipe_not_trusted", bench.shown(&said));
    }
    assert_eq!(bench.files(), ["recipe.toml"]);
}

#[test]
fn a_plugin_that_the_recipe_lists_but_that_is_not_there_is_shown_in_it() {
    let recipe = changed(SADDLE, "format = 1\n", "format = 1\nplugins = [\"labs\"]\n");
    let bench = Bench::with(&recipe);
    let said = bench.line("run recipe.toml --trust-recipe");
    insta::assert_snapshot!("listed_plugin_missing", bench.shown(&said.ends(2)));
}

#[test]
fn a_sampler_with_a_state_gives_the_same_bytes_for_any_threads() {
    let recipe = saddle_with("sampler", "use = \"phase\"");
    let folder = plugin_folder(&["sequential"]);
    let run = |threads: &str| {
        let bench = Bench::with(&recipe);
        let sets = ["--set", "tool.nose_radius=0.2mm", "--threads", threads];
        let summary = run_with(&bench, &folder, &sets);
        holds(&summary, 100.0);
        assert!(summary["revolutions"].as_f64().unwrap() > 3.0 * 64.0);
        bench.read("out/toolpath.csv")
    };
    let one = run("1");
    assert!(one == run("3"));
    assert_steps(&one, 10.3);
}

/// All steps of C but the last are this many degrees: nothing starts again at a block's border.
fn assert_steps(path: &str, degrees: f64) {
    let c: Vec<f64> = path
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    let steps: Vec<f64> = c.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (_, all_but_last) = steps.split_last().unwrap();
    for step in all_but_last {
        assert!((step - degrees).abs() < 1e-6, "{step}");
    }
}

#[test]
fn a_compensator_with_nothing_but_centre_gives_the_path_of_the_built_in() {
    let folder = plugin_folder(&["plain-compensator"]);
    let path_with = |compensator: &str| {
        let lines = format!("use = \"{compensator}\"");
        let analytic = saddle_with("velocity", "use = \"analytic\"");
        let bench = Bench::with(&with_table(&analytic, "compensator", &lines));
        let summary = run_with(&bench, &folder, &[]);
        holds(&summary, 100.0);
        numbers(&bench.read("out/toolpath.csv"))
    };
    let (own, built_in) = (path_with("plain-normal"), path_with("normal"));
    assert_eq!(own.len(), built_in.len());
    for (own, built_in) in own.iter().zip(&built_in) {
        // The fit of the rates is good to about 1e-9 of them; positions are the same formula.
        for (own, built_in) in own.iter().zip(built_in) {
            let difference = (own - built_in).abs();
            assert!(
                difference <= 1e-6 * built_in.abs().max(1.0),
                "{own}, {built_in}"
            );
        }
    }
}

fn numbers(path: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|v| v.parse().unwrap()).collect();
    path.lines().skip(1).map(row).collect()
}
