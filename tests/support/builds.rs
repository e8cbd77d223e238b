//! Builds that the tests start themselves, and the libraries of the build that made the tests.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use tempfile::TempDir;

use super::fixtures::file_name;

/// The packages of the built-in plugins.
pub const BUILT_INS: [&str; 13] = [
    "turnpath-atpg",
    "turnpath-ats",
    "turnpath-constant",
    "turnpath-fft-adaptive",
    "turnpath-formula",
    "turnpath-grid",
    "turnpath-integrated",
    "turnpath-minimax",
    "turnpath-nose-radius",
    "turnpath-polynomials",
    "turnpath-spindle",
    "turnpath-surfaces",
    "turnpath-triangle-rotary",
];

/// The program with an empty catalogue, the example `without_built_ins`, in the profile of this
/// test.
///
/// The build of all tests makes it: then cargo finds it done. It is built here after a build of one
/// suite alone.
pub fn bare_program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let example = ["--workspace", "--example", "without_built_ins"];
        let folder = build_program(&example, &target(), &target());
        folder
            .join("examples")
            .join(executable("without_built_ins"))
    })
}

/// The program that is built without the feature `built-ins`.
///
/// It has a target folder of its own, since both programs have one name. All other artefacts are
/// those of the build that made this test; a cargo that does not know `build-dir` makes them again.
pub fn program_without_the_feature() -> PathBuf {
    let bare = ["--bin", "turnpath", "--no-default-features"];
    let folder = build_program(&bare, &target_folder("bare"), &target());
    folder.join(executable("turnpath"))
}

/// Builds targets of the program's package in the profile of this test; gives the profile's folder.
fn build_program(targets: &[&str], target: &Path, artefacts: &Path) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let mut cargo = cargo("build", &manifest, target);
    cargo.args(targets).env("CARGO_BUILD_BUILD_DIR", artefacts);
    let profile = match cfg!(debug_assertions) {
        true => "debug",
        false => "release",
    };
    if profile == "release" {
        cargo.arg("--release");
    }
    run(cargo);
    target.join(profile)
}

fn executable(name: &str) -> String {
    format!("{name}{}", std::env::consts::EXE_SUFFIX)
}

/// A plugin folder with copies of the built-in plugins' libraries, which cargo puts beside the
/// test program.
pub fn built_in_libraries() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let test = std::env::current_exe().expect("the test's own path");
    for package in BUILT_INS {
        let name = file_name(package);
        fs::copy(test.with_file_name(&name), folder.path().join(&name))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    folder
}

/// A folder in the target folder.
pub fn target_folder(name: &str) -> PathBuf {
    target().join(name)
}

/// The target folder, in which the tests' scratch folder lies directly.
pub fn target() -> PathBuf {
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    scratch.parent().expect("the target folder").to_owned()
}

/// Cargo on a manifest, with a target folder of its own.
pub fn cargo(command: &str, manifest: &Path, target: &Path) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args([command, "--quiet", "--manifest-path"])
        .arg(manifest)
        .arg("--target-dir")
        .arg(target)
        // A target for the tests themselves would move the results to another folder.
        .env_remove("CARGO_BUILD_TARGET");
    cargo
}

/// Runs cargo, which must succeed.
pub fn run(mut cargo: Command) {
    let output = cargo.output().expect("cargo runs");
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
}
