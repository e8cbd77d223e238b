//! `cargo xtask msrv`: the oldest Rust version that the workspace promises.

use std::process::Command;

use cargo_metadata::semver::Version;
use cargo_metadata::{Metadata, MetadataCommand};

use crate::commands::{command, repository, run, succeeds, target};
use crate::step::{Outcome, Step};

/// Checks that no dependency asks for a newer version, and builds with that version if it is
/// installed.
pub fn run_checks() -> Vec<Step> {
    let (metadata, promised) = match workspace() {
        Ok(found) => found,
        Err(reason) => return vec![Step::run("msrv", || Outcome::Failed(reason))],
    };
    vec![
        Step::run(
            format!("msrv: no dependency needs more than {promised}"),
            || match newer(&metadata, &promised) {
                none if none.is_empty() => Outcome::Passed,
                newer => Outcome::Failed(newer.join(", ")),
            },
        ),
        Step::run(
            format!("msrv: the workspace builds with {promised}"),
            || build(&promised),
        ),
    ]
}

/// The workspace, and the version that all its packages promise.
fn workspace() -> Result<(Metadata, Version), String> {
    let metadata = MetadataCommand::new()
        .current_dir(repository())
        .other_options(vec!["--locked".to_owned()])
        .exec()
        .map_err(|error| error.to_string())?;
    let mut promised: Vec<Version> = Vec::new();
    for package in metadata.workspace_packages() {
        match &package.rust_version {
            Some(version) => promised.push(version.clone()),
            None => return Err(format!("{} has no rust-version", package.name)),
        }
    }
    promised.dedup();
    match promised.as_slice() {
        [one] => Ok((metadata.clone(), one.clone())),
        several => Err(format!(
            "the workspace promises several versions: {several:?}"
        )),
    }
}

/// The packages that ask for a newer version, with that version.
fn newer(metadata: &Metadata, promised: &Version) -> Vec<String> {
    let packages = metadata.packages.iter();
    let newer = packages.filter_map(|package| {
        let asked = package.rust_version.as_ref()?;
        (asked > promised).then(|| format!("{} needs {asked}", package.name))
    });
    newer.collect()
}

fn build(promised: &Version) -> Outcome {
    let toolchain = format!("{}.{}", promised.major, promised.minor);
    let with = |words: &[&str]| -> Command { command("rustup", words) };
    if !succeeds(with(&["run", &toolchain, "cargo", "--version"])) {
        return Outcome::Skipped(format!(
            "Rust {toolchain} is not installed: `rustup toolchain install {toolchain}`"
        ));
    }
    let words = [
        "run",
        &toolchain,
        "cargo",
        "check",
        "--locked",
        "--workspace",
        "--all-targets",
    ];
    let mut check = with(&words);
    // Cargo tells the programs that it starts which toolchain it is.
    check
        .env_remove("RUSTUP_TOOLCHAIN")
        .env_remove("CARGO")
        .env_remove("RUSTC");
    check.arg("--target-dir").arg(target().join("msrv"));
    run(check)
}
