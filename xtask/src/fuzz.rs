//! `cargo xtask fuzz`: libFuzzer on the targets of `tests/fuzz`, for a stated time each.

use std::fs;
use std::process::Command;

use crate::commands::{command, repository, run, succeeds, target};
use crate::step::{Outcome, Step};

/// Seconds for each target; `FUZZ_SECONDS` in the environment gives others.
const SECONDS: u64 = 60;
/// libFuzzer's instrumentation needs a nightly compiler.
const TOOLCHAIN: &str = "nightly";
/// Longest time of one input, s, and most memory, MiB.
const LIMITS: [&str; 2] = ["-timeout=10", "-rss_limit_mb=2048"];

/// Fuzzes the targets of these names, or all.
pub fn run_targets(names: &[&str]) -> Vec<Step> {
    let known = match targets() {
        Ok(known) => known,
        Err(reason) => return vec![Step::run("fuzz", || Outcome::Failed(reason))],
    };
    let unknown = names
        .iter()
        .find(|name| !known.iter().any(|one| one == *name));
    if let Some(unknown) = unknown {
        let reason = format!("no target `{unknown}`: {}", known.join(", "));
        return vec![Step::run("fuzz", || Outcome::Failed(reason))];
    }
    if let Some(reason) = missing() {
        return vec![Step::run("fuzz", || Outcome::Skipped(reason))];
    }
    let chosen = |name: &&String| names.is_empty() || names.contains(&name.as_str());
    let steps = known.iter().filter(chosen);
    steps
        .map(|name| Step::run(format!("fuzz: {name}, {} s", seconds()), || fuzz(name)))
        .collect()
}

/// The names of the targets: those of the folders of the corpus.
fn targets() -> Result<Vec<String>, String> {
    let corpus = repository().join("tests/fuzz/corpus");
    let entries = fs::read_dir(&corpus).map_err(|error| error.to_string())?;
    let names = entries.flatten().map(|entry| entry.file_name());
    let mut names: Vec<String> = names.filter_map(|name| name.into_string().ok()).collect();
    names.sort();
    Ok(names)
}

/// The tool that is missing, if one is.
fn missing() -> Option<String> {
    if !succeeds(with_toolchain(&["--version"])) {
        return Some(format!(
            "there is no {TOOLCHAIN} compiler: `rustup toolchain install {TOOLCHAIN}`"
        ));
    }
    let there = succeeds(with_toolchain(&["fuzz", "--version"]));
    (!there).then(|| "cargo-fuzz is not installed: `cargo install cargo-fuzz --locked`".to_owned())
}

/// Cargo of that toolchain.
fn with_toolchain(words: &[&str]) -> Command {
    let mut cargo = command("rustup", &["run", TOOLCHAIN, "cargo"]);
    // Cargo tells the programs that it starts which toolchain it is.
    cargo
        .args(words)
        .env_remove("RUSTUP_TOOLCHAIN")
        .env_remove("CARGO")
        .env_remove("RUSTC");
    cargo
}

fn seconds() -> u64 {
    let given = std::env::var("FUZZ_SECONDS").ok();
    given
        .and_then(|given| given.parse().ok())
        .unwrap_or(SECONDS)
}

/// Fuzzes one target. What is new goes into the target folder and is the beginning of the next time;
/// an input that fails is kept beside it.
fn fuzz(name: &str) -> Outcome {
    let folder = target().join("fuzz");
    let (found, failed) = (folder.join("corpus").join(name), folder.join("failed"));
    for folder in [&found, &failed] {
        if let Err(error) = fs::create_dir_all(folder) {
            return Outcome::Failed(format!("{}: {error}", folder.display()));
        }
    }
    let words = ["fuzz", "run", "--fuzz-dir", "tests/fuzz"];
    let mut fuzz = with_toolchain(&words);
    fuzz.args(["--sanitizer", "none", name])
        .arg(&found)
        .arg(format!("tests/fuzz/corpus/{name}"))
        .arg("--")
        .args(LIMITS)
        .arg(format!("-max_total_time={}", seconds()))
        .arg(format!("-artifact_prefix={}/{name}-", failed.display()))
        .env("CARGO_TARGET_DIR", folder.join("build"));
    run(fuzz)
}
