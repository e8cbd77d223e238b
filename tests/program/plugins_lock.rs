//! `--plugins-lock`: only libraries with the hash of the lock are loaded, and `list --lock` writes it.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Bench, answer};
use crate::support::bench_with_plugins::{bench, refused_call};
use crate::support::fixtures::{file_name, library};
use crate::support::recipe::{SADDLE, saddle_with};

const RUN: &str = "run recipe.toml -o out --plugin-dir plugins --plugins-lock plugins.lock";

/// A bench whose lock has its only plugin.
fn locked() -> Bench {
    let recipe = saddle_with("sampler", "use = \"constant-arc\"\nspacing = \"0.5 mm\"");
    let bench = bench(&recipe, &["constant-arc"]);
    bench
        .line("list --plugin-dir plugins --lock=plugins.lock")
        .ends(0);
    bench
}

#[test]
fn a_locked_plugin_is_loaded() {
    let bench = locked();
    bench.line(RUN).ends(0);
    for command in ["check", "ablate", "verify", "sag", "explain"] {
        let help = bench.line(&format!("{command} --help")).ends(0);
        assert!(help.stdout.contains("--plugins-lock"), "{command}");
    }
}

#[test]
fn the_lock_is_that_of_the_files() {
    let bench = locked();
    let written = bench.read("plugins.lock");
    let printed = bench.line("list --plugin-dir plugins --lock").ends(0);
    assert_eq!(printed.stdout, written);
    let lock: serde_json::Value = toml::from_str(&written).unwrap();
    let sum = std::process::Command::new("sha256sum")
        .arg(library("constant-arc"))
        .output()
        .unwrap();
    let sum = String::from_utf8(sum.stdout).unwrap();
    let plugins = lock["plugin"].as_array().unwrap();
    assert_eq!(plugins.len(), 1, "{written}");
    assert_eq!(plugins[0]["sha256"], sum.split_whitespace().next().unwrap());
    assert_eq!(plugins[0]["file"], file_name("constant-arc"));
    assert_eq!(plugins[0]["name"], "constant-arc");
}

#[test]
fn a_library_that_has_changed_is_refused_with_both_hashes() {
    let bench = locked();
    let name = format!("plugins/{}", file_name("constant-arc"));
    let mut bytes = fs::read(bench.path(&name)).unwrap();
    bytes.push(0);
    bench.write(&name, &bytes);
    let said = refused_call(&bench, RUN);
    let lock = bench.read("plugins.lock");
    let locked = lock.split("sha256 = \"").nth(1).unwrap();
    assert!(said.stderr.contains(&locked[..12]), "{said}");
    assert!(said.stderr.contains("its SHA-256 is"), "{said}");
    assert!(said.stderr.contains(&file_name("constant-arc")), "{said}");
}

/// Its initialiser would end the process: the lock is asked before the library is tried.
#[test]
fn a_library_that_is_not_in_the_lock_is_refused_before_any_of_its_code_runs() {
    let bench = locked();
    let name = file_name("acts-when-loaded");
    fs::copy(
        library("acts-when-loaded"),
        bench.path("plugins").join(&name),
    )
    .unwrap();
    let mut command = bench.command(RUN.split(' '));
    let said = answer(command.env("TURNPATH_TEST_INITIALISER", "abort")).ends(3);
    assert!(said.stderr.contains("it is not in plugins.lock"), "{said}");
    assert!(said.stderr.contains(&name), "{said}");
    assert!(!bench.path("out").exists() && bench.scratch_is_empty());
}

#[test]
fn the_plugins_of_a_recipe_are_held_to_the_lock_too() {
    let bench = bench(SADDLE, &["constant-arc"]);
    bench.line("list --lock=plugins.lock").ends(0);
    let list = format!("plugins = [\"plugins/{}\"]", file_name("constant-arc"));
    bench.write(
        "recipe.toml",
        SADDLE.replacen("name =", &format!("{list}\nname ="), 1),
    );
    let words = "check recipe.toml --trust-recipe --plugins-lock plugins.lock";
    let said = refused_call(&bench, words);
    assert!(said.stderr.contains("it is not in plugins.lock"), "{said}");
    bench.line("check recipe.toml --trust-recipe").ends(0);
}

#[test]
fn what_is_not_a_lock_is_told() {
    let bench = bench(SADDLE, &[]);
    let call = |lock: &str| bench.call(["list", "--plugins-lock", lock]);
    let said = call("recipe.toml").ends(2);
    assert!(said.stderr.contains("is not a plugins' lock"), "{said}");
    call("none.lock").ends(4);
    call("plugins").ends(4);
}
