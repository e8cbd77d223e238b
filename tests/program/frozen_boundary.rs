//! A plugin on the boundary as of `turnpath-plugin` 0.2.0, of which `tests/fixtures/boundary-0.2.0`
//! has a frozen copy: this build loads it, and it gives the bytes that it gave then.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::support::bench::Bench;
use crate::support::builds::{self, cargo, run};
use crate::support::fixtures::file_name;
use crate::support::repository;
use turnpath_host::sha256_hex;

/// The slots with the plugin's strategies.
const STRATEGIES: [&str; 6] = [
    "surface/frozen-bowl",
    "feed/frozen-even",
    "sampler/frozen-steps",
    "compensator/frozen-normal",
    "velocity/frozen-rates",
    "spindle/frozen-two-speeds",
];

fn frozen() -> PathBuf {
    repository().join("tests/fixtures/boundary-0.2.0")
}

/// The library, built from the frozen copy.
fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let target = builds::target_folder("fixtures");
        let mut build = cargo("build", &frozen().join("Cargo.toml"), &target);
        build.arg("--locked");
        // Most dependencies are those of the tests.
        build.env("CARGO_BUILD_BUILD_DIR", builds::target());
        run(build);
        target.join("debug").join(file_name("every-slot"))
    })
}

/// A bench with the frozen recipe, its data file, and the library in a plugin folder.
fn bench() -> Bench {
    let read = |name: &str| fs::read(frozen().join(name)).unwrap();
    let bench = Bench::empty();
    bench.write("recipe.toml", read("recipe.toml"));
    bench.write("curvature.txt", read("curvature.txt"));
    fs::create_dir(bench.path("plugins")).unwrap();
    let copy = bench.path("plugins").join(file_name("every-slot"));
    fs::copy(library(), copy).unwrap();
    bench
}

/// The lines of a file that are no comment, hashed. A program's first comment has the version. Its
/// approach and its retreat are younger than what was recorded, and the plugin has no part in them.
fn hash(text: &str) -> String {
    let (mut lines, mut is_path) = (Vec::new(), true);
    for line in text.lines() {
        match line {
            "; -- approach --" | "; -- retreat --" => is_path = false,
            line if line.starts_with("; --") => is_path = true,
            _ => {}
        }
        if is_path && !line.starts_with(';') {
            lines.push(line);
        }
    }
    sha256_hex(lines.join("\n").as_bytes())
}

#[test]
fn a_plugin_of_each_slot_loads_and_gives_the_same_bytes() {
    let bench = bench();
    bench
        .line("run recipe.toml -o out --plugin-dir plugins")
        .ends(0);
    let recorded = fs::read_to_string(frozen().join("sha256.txt")).unwrap();
    let found: String = ["toolpath.csv", "recipe.pmc"]
        .map(|name| {
            format!(
                "{}  {name}\n",
                hash(&bench.read(Path::new("out").join(name)))
            )
        })
        .concat();
    assert_eq!(found, recorded);
}

#[test]
fn its_strategies_are_explained_with_their_parameters() {
    let bench = bench();
    for strategy in STRATEGIES {
        let said = bench.line(&format!("explain {strategy} --plugin-dir plugins"));
        let plugins = bench.path("plugins").display().to_string();
        let shown = said.ends(0).stdout.replace(&plugins, "[plugins]");
        // The keys of the host follow, and they may change.
        let (own, _) = shown.split_once("\n  every ").unwrap_or((&shown, ""));
        insta::assert_snapshot!(strategy.replace(['/', '-'], "_"), own);
    }
}

#[test]
fn its_errors_arrive() {
    let bench = bench();
    let said = bench
        .line("check recipe.toml --plugin-dir plugins --set sampler.steps=2")
        .ends(2);
    assert!(said.stderr.contains("`steps` must be at least 3"), "{said}");
    bench.write("curvature.txt", "steep");
    let said = bench.line("check recipe.toml --plugin-dir plugins").ends(2);
    assert!(said.stderr.contains("it has no number"), "{said}");
}
