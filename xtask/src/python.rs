//! The reference scripts' Python, and the packages that it has.

use std::path::Path;
use std::process::Command;

use crate::commands::{command, succeeds};
use crate::step::Outcome;

/// The interpreter: the environment variable `PYTHON`, or `python3`.
pub fn interpreter() -> String {
    std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// A call of a script in the repository.
pub fn script(file: &str, rest: &[&Path]) -> Command {
    let mut call = command(interpreter(), &[file]);
    call.args(rest);
    call
}

/// Runs the body if Python and these packages are installed.
pub fn with_packages(packages: &[&str], body: impl FnOnce() -> Outcome) -> Outcome {
    with_packages_of(&interpreter(), packages, body)
}

/// Runs the body if this interpreter and these packages are installed.
pub fn with_packages_of(
    python: &str,
    packages: &[&str],
    body: impl FnOnce() -> Outcome,
) -> Outcome {
    if !succeeds(command(python, &["--version"])) {
        return Outcome::Skipped(format!("`{python}` is not installed"));
    }
    let has = |package: &str| succeeds(command(python, &["-c", &format!("import {package}")]));
    let missing: Vec<&str> = packages.iter().copied().filter(|one| !has(one)).collect();
    if missing.is_empty() {
        return body();
    }
    Outcome::Skipped(format!("`{python}` has no {}", missing.join(", ")))
}
