//! A bench with plugins that misbehave, and what every such plugin must come to.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use super::bench::{Answer, Bench};
use super::fixtures::{file_name, library};

/// A bench with plugins in its folder `plugins`.
pub fn bench(recipe: &str, fixtures: &[&str]) -> Bench {
    let bench = Bench::with(recipe);
    fs::create_dir(bench.path("plugins")).unwrap();
    for fixture in fixtures {
        let copy = bench.path("plugins").join(file_name(fixture));
        fs::copy(library(fixture), copy).unwrap();
    }
    bench
}

/// Runs a recipe that must fail by its plugin, and checks that it leaves no file.
#[track_caller]
pub fn refused(bench: &Bench) -> Answer {
    refused_call(bench, "run recipe.toml -o out --plugin-dir plugins")
}

/// The same with other words.
#[track_caller]
pub fn refused_call(bench: &Bench, words: &str) -> Answer {
    let before = bench.files();
    let said = bench.line(words);
    let said = said.ends(3);
    assert_eq!(bench.files(), before, "files are left");
    assert!(!bench.path("out").exists(), "a folder is left");
    assert!(bench.scratch_is_empty(), "temporary files are left");
    assert_eq!(said.stdout, "");
    said
}
