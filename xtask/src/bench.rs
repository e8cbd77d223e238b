//! `cargo xtask bench`: the program against scripts of the same chain, and its section of
//! docs/benchmarks.md.

use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{cargo, run, target};
use crate::long::program;
use crate::python::{script, with_packages};
use crate::step::{Outcome, Step};

/// What times the programs.
const SCRIPT: &str = "tests/reference/speed/bench.py";
/// The crates with built-in strategies. Each is a library that a program can load.
const BUILT_IN: [&str; 13] = [
    "atpg",
    "ats",
    "constant",
    "fft_adaptive",
    "formula",
    "grid",
    "integrated",
    "minimax",
    "nose_radius",
    "polynomials",
    "spindle",
    "surfaces",
    "triangle_rotary",
];
/// Plugins of tests/fixtures that make twenty with them.
const OTHERS: [&str; 7] = [
    "bowl-file",
    "constant-arc",
    "plain-compensator",
    "template-compensator",
    "template-feed",
    "template-sampler",
    "two-speeds",
];

/// Times everything; `words` go to the script. What the words are is said without building anything.
pub fn run_bench(words: &[&str]) -> Vec<Step> {
    if words.iter().any(|word| matches!(*word, "--help" | "-h")) {
        let help = || run(script(SCRIPT, &[Path::new("--help")]));
        return vec![Step::run("bench", help)];
    }
    let bench = || {
        with_packages(&["numpy", "numba"], || {
            bench(words).unwrap_or_else(|end| end)
        })
    };
    vec![Step::run("bench", bench)]
}

fn bench(words: &[&str]) -> Result<Outcome, Outcome> {
    let (bare, own) = (bare_program()?, program()?);
    let release = own.parent().unwrap_or(Path::new("")).to_owned();
    passed(cargo(&[
        "build",
        "--locked",
        "--release",
        "--package",
        "turnpath-cli",
        "--example",
        "chain",
    ]))?;
    let plugins = plugins(&release.join("deps"))?;
    let chain = release.join("examples").join("chain");
    let mut call = script(SCRIPT, &[&own, &chain, &bare, &plugins]);
    call.args(words);
    Ok(run(call))
}

/// The program without a strategy inside. It takes the other one's place for a moment.
fn bare_program() -> Result<PathBuf, Outcome> {
    let name = format!("turnpath{}", std::env::consts::EXE_SUFFIX);
    passed(cargo(&[
        "build",
        "--locked",
        "--release",
        "--bin",
        "turnpath",
        "--no-default-features",
    ]))?;
    let bare = target().join("bench").join(&name);
    copy(&target().join("release").join(&name), &bare)?;
    Ok(bare)
}

/// A folder with twenty plugins.
fn plugins(libraries: &Path) -> Result<PathBuf, Outcome> {
    let fixtures = target().join("fixtures");
    let manifest = "tests/fixtures/Cargo.toml";
    let mut call = cargo(&[
        "build",
        "--locked",
        "--release",
        "--manifest-path",
        manifest,
        "--target-dir",
    ]);
    call.arg(&fixtures);
    OTHERS.iter().for_each(|package| {
        call.args(["--package", package]);
    });
    passed(call)?;
    let file = |name: &str| {
        let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
        format!("{prefix}{name}{suffix}")
    };
    let folder = target().join("bench").join("plugins");
    for name in BUILT_IN {
        let file = file(&format!("turnpath_{name}"));
        copy(&libraries.join(&file), &folder.join(&file))?;
    }
    for name in OTHERS {
        let file = file(&name.replace('-', "_"));
        copy(&fixtures.join("release").join(&file), &folder.join(&file))?;
    }
    Ok(folder)
}

fn passed(call: std::process::Command) -> Result<(), Outcome> {
    match run(call) {
        Outcome::Passed => Ok(()),
        failed => Err(failed),
    }
}

fn copy(from: &Path, to: &Path) -> Result<(), Outcome> {
    let folder = to.parent().unwrap_or(Path::new(""));
    let copied = fs::create_dir_all(folder).and_then(|()| fs::copy(from, to));
    match copied {
        Ok(_) => Ok(()),
        Err(error) => Err(Outcome::Failed(format!("{}: {error}", from.display()))),
    }
}
