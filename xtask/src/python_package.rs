//! `cargo xtask python`: the wheel of the Python package, built, installed into an empty environment,
//! and tested there.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{cargo, command, repository, run, succeeds, target};
use crate::python::interpreter;
use crate::step::{Outcome, Step};

/// The package's folder.
const PACKAGE: &str = "crates/python";

/// Builds and tests the package.
pub fn run_checks() -> Vec<Step> {
    let Some(builder) = environment("builder", &["maturin>=1.16,<2"]) else {
        let missing =
            "python3 with `venv`, and a package index with maturin, are not there".to_owned();
        return vec![Step::run("python package", || Outcome::Skipped(missing))];
    };
    let lints = Step::run("python package, lints", lints);
    let wheel = Step::run("python package, wheel", || build(&builder));
    let tests = Step::run("python package, tests", || match wheel.outcome {
        Outcome::Passed => test(),
        _ => Outcome::Skipped("there is no wheel".to_owned()),
    });
    vec![lints, wheel, tests]
}

/// The folder of environments and wheels.
fn folder() -> PathBuf {
    target().join("python-package")
}

/// The interpreter of a fresh environment with these packages; `None` where it cannot be made.
fn environment(name: &str, packages: &[&str]) -> Option<PathBuf> {
    let place = folder().join(name);
    let words = ["-m", "venv", "--clear"];
    let mut make = command(interpreter(), &words);
    make.arg(&place);
    if !succeeds(make) {
        return None;
    }
    let programs = if cfg!(windows) { "Scripts" } else { "bin" };
    let python = place.join(programs).join("python");
    let mut install = pip(&python);
    install.args(packages);
    succeeds(install).then_some(python)
}

fn pip(python: &Path) -> Command {
    command(python, &["-m", "pip", "install", "--quiet"])
}

fn lints() -> Outcome {
    let manifest = format!("{PACKAGE}/Cargo.toml");
    let words = [
        "clippy",
        "--locked",
        "--release",
        "--manifest-path",
        &manifest,
    ];
    let mut clippy = cargo(&words);
    clippy.args(["--", "-D", "warnings"]);
    run(clippy)
}

fn build(builder: &Path) -> Outcome {
    let wheels = folder().join("wheels");
    // An older wheel would be taken for the new one.
    let _ = std::fs::remove_dir_all(&wheels);
    let words = ["-m", "maturin", "build", "--release", "--locked", "--out"];
    let mut maturin = command(builder, &words);
    maturin
        .arg(&wheels)
        .current_dir(repository().join(PACKAGE))
        .env("CARGO_TARGET_DIR", target());
    run(maturin)
}

fn test() -> Outcome {
    let wheels = std::fs::read_dir(folder().join("wheels"))
        .into_iter()
        .flatten();
    let mut wheels = wheels.flatten().map(|entry| entry.path());
    let Some(wheel) = wheels.next() else {
        return Outcome::Failed("maturin left no wheel".to_owned());
    };
    let wheel = format!("{}[test]", wheel.display());
    let Some(python) = environment("empty", &[&wheel]) else {
        return Outcome::Failed("the wheel cannot be installed".to_owned());
    };
    let mut tests = command(python, &["-m", "pytest", "-q", "tests"]);
    tests.current_dir(repository().join(PACKAGE));
    run(tests)
}
