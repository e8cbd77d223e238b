//! Data files of strategies: read beside the recipe, named by their hashes, and refused with their
//! place in the recipe.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Answer, Bench};
use crate::support::fixtures::{file_name, library};
use crate::support::recipe::saddle_with;
use serde_json::{Value, json};

/// SHA-256 of "-0.02\n".
const SHA256: &str = "d23ba0fd6364dded4e3b2dca145405a3b8ab465821d768f58c3bac0f164b9123";

/// A bench with the saddle's recipe on the surface of a file, and with that surface's plugin.
fn bench(file: &str) -> Bench {
    let bench = Bench::with(&saddle_with(
        "surface",
        &format!("use = \"bowl-file\"\nfile = \"{file}\""),
    ));
    fs::create_dir(bench.path("plugins")).unwrap();
    let copy = bench.path("plugins").join(file_name("bowl-file"));
    fs::copy(library("bowl-file"), copy).unwrap();
    bench
}

fn run(bench: &Bench, rest: &str) -> Answer {
    bench.line(&format!(
        "run recipe.toml -o out --plugin-dir plugins {rest}"
    ))
}

/// The message of a run that fails and leaves nothing behind.
#[track_caller]
fn refused(bench: &Bench, status: i32) -> String {
    let said = run(bench, "").ends(status);
    assert_eq!(said.stdout, "");
    assert!(!bench.path("out").exists(), "a folder is left");
    bench.shown(&said)
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/summary.json")).unwrap()
}

#[test]
fn a_file_is_relative_to_the_recipe_and_its_hash_is_in_the_summary() {
    let bench = bench("maps/bowl.txt");
    fs::create_dir_all(bench.path("jobs/maps")).unwrap();
    bench.write("jobs/maps/bowl.txt", "-0.02\n");
    fs::rename(bench.path("recipe.toml"), bench.path("jobs/recipe.toml")).unwrap();
    let line = "run jobs/recipe.toml -o out --plugin-dir plugins";
    bench.line(line).ends(0);
    let expected = json!([{
        "slot": "surface",
        "param": "file",
        "file": "maps/bowl.txt",
        "bytes": 6,
        "sha256": SHA256,
    }]);
    assert_eq!(summary(&bench)["data_files"], expected);
    // A `--set` is relative to the recipe too.
    bench.write("jobs/other.txt", "-0.03");
    let set = ["--set", "surface.file=other.txt"];
    bench.call(line.split(' ').chain(set)).ends(0);
    assert_eq!(summary(&bench)["data_files"][0]["file"], "other.txt");
}

#[test]
fn a_run_without_data_files_has_an_empty_list() {
    let bench = Bench::with(crate::support::recipe::SADDLE);
    bench.line("run recipe.toml -o out").ends(0);
    assert_eq!(summary(&bench)["data_files"], json!([]));
}

#[test]
fn a_file_that_is_not_there() {
    insta::assert_snapshot!(refused(&bench("bowl.txt"), 4));
}

#[test]
fn a_folder_in_place_of_a_file() {
    insta::assert_snapshot!(refused(&bench("plugins"), 4));
}

/// The system gives an error for the first byte of this file, whoever reads it.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_cannot_be_read() {
    insta::assert_snapshot!(refused(&bench("/proc/self/mem"), 4));
}

#[test]
fn a_file_that_the_strategy_refuses() {
    let bench = bench("bowl.txt");
    bench.write("bowl.txt", "");
    insta::assert_snapshot!(refused(&bench, 2));
}

#[test]
fn check_verify_and_sag_read_the_file_and_explain_does_not() {
    let bench = bench("bowl.txt");
    let explained = bench.line("explain bowl-file --plugin-dir plugins");
    let folder = bench.path("plugins").display().to_string();
    let text = explained.ends(0).stdout.replace(&folder, "[folder]");
    insta::assert_snapshot!(text.replace("0.1.0", "[version]"));
    for command in ["check recipe.toml", "sag recipe.toml --grid 3 -o grid.csv"] {
        let said = bench.line(&format!("{command} --plugin-dir plugins"));
        let said = said.ends(4).stderr;
        assert!(said.contains("bowl.txt"), "{command}: {said}");
    }
    bench.write("bowl.txt", "-0.02");
    run(&bench, "").ends(0);
    let verify = "verify recipe.toml out/toolpath.csv --plugin-dir plugins";
    bench.line(verify).ends(0);
}

#[test]
fn an_ablation_makes_a_run_again_when_its_file_has_changed() {
    let bench = bench("bowl.txt");
    let recipe = bench.read("recipe.toml");
    let list = "[ablation]\nsurface.file = [\"other.txt\"]\n";
    bench.write("recipe.toml", format!("{recipe}\n{list}"));
    let line = "ablate recipe.toml -o out --plugin-dir plugins";
    let said = bench.line(line).ends(4).stderr;
    assert!(said.contains("bowl.txt"), "{said}");
    bench.write("bowl.txt", "-0.02");
    bench.write("other.txt", "-0.03");
    let records = || fs::read_dir(bench.path("out/runs")).unwrap().count();
    bench.line(line).ends(0);
    assert_eq!(records(), 2);
    bench.line(line).ends(0);
    assert_eq!(records(), 2);
    bench.write("other.txt", "-0.025");
    bench.line(line).ends(0);
    assert_eq!(records(), 3);
}
