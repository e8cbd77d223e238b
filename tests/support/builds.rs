//! Builds that the tests start themselves, and the libraries of the build that made the tests.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use tempfile::TempDir;

use super::fixtures::file_name;

/// The packages of the built-in plugins.
pub const BUILT_INS: [&str; 8] = [
    "turnpath-atpg",
    "turnpath-ats",
    "turnpath-constant",
    "turnpath-fft-adaptive",
    "turnpath-integrated",
    "turnpath-nose-radius",
    "turnpath-surfaces",
    "turnpath-triangle-rotary",
];

/// The program without plugins inside, in the profile of this test; built when first asked for.
///
/// It has a target folder of its own, since both programs have one name. All other artefacts are
/// those of the build that made this test; a cargo that does not know `build-dir` makes them again.
pub fn bare_program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let target = target_folder("bare");
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        let mut cargo = cargo("build", &manifest, &target);
        cargo
            .args(["--bin", "turnpath", "--no-default-features"])
            .env("CARGO_BUILD_BUILD_DIR", target_folder("."));
        if !cfg!(debug_assertions) {
            cargo.arg("--release");
        }
        run(cargo);
        let profile = if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        };
        let name = format!("turnpath{}", std::env::consts::EXE_SUFFIX);
        target.join(profile).join(name)
    })
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

/// A folder beside the tests' scratch folder, which lies directly in the target folder.
pub fn target_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name(name)
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
