//! Builds the plugins of `tests/fixtures`, for whichever test includes this file with `#[path]`.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The folder with all fixtures' libraries, built when first asked for.
///
/// Cargo locks the folders, so test programs may build at the same time.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(build)
}

fn build() -> PathBuf {
    // The tests' scratch folder lies directly in the target folder.
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let of_tests = scratch.parent().expect("the target folder");
    let target = of_tests.join("fixtures");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--locked", "--quiet", "--manifest-path"])
        .arg(manifest())
        .arg("--target-dir")
        .arg(&target)
        // Most dependencies are there already. A cargo that does not know this folder makes them again.
        .env("CARGO_BUILD_BUILD_DIR", of_tests)
        // A target for the tests themselves would move the libraries to another folder.
        .env_remove("CARGO_BUILD_TARGET")
        .status()
        .expect("cargo runs");
    assert!(status.success(), "the fixtures build");
    target.join("debug")
}

fn manifest() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("tests/fixtures/Cargo.toml"))
        .find(|manifest| manifest.is_file())
        .expect("the fixtures lie in the repository's tests")
}

/// A library's file name: `constant-arc` is in `libconstant_arc.so`.
pub fn file_name(package: &str) -> String {
    format!("{DLL_PREFIX}{}{DLL_SUFFIX}", package.replace('-', "_"))
}

/// The library of one fixture.
pub fn library(package: &str) -> PathBuf {
    let library = folder().join(file_name(package));
    assert!(library.is_file(), "{} was built", library.display());
    library
}

/// A plugin folder with copies of these fixtures' libraries.
pub fn plugin_folder(packages: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for package in packages {
        let copy = folder.path().join(file_name(package));
        fs::copy(library(package), copy).expect("a copy of the library");
    }
    folder
}
