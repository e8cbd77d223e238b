//! Libraries that `cargo test` does not build once more for tests of their own: `test = false`.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;

use cargo_metadata::TargetKind;

use crate::workspace::workspace;

/// What begins a test in a source file.
const TESTS: [&str; 3] = ["#[test]", "#[cfg(test)]", "proptest!"];

/// The source files of a folder and of those below it that have tests.
fn files_with_tests(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files_with_tests(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("a source file");
            if TESTS.iter().any(|test| text.contains(test)) {
                found.push(path.display().to_string());
            }
        }
    }
}

#[test]
fn a_library_whose_tests_are_not_built_has_none() {
    let metadata = workspace();
    let (mut unbuilt, mut found) = (0, Vec::new());
    for target in metadata.packages.iter().flat_map(|one| &one.targets) {
        if target.kind.contains(&TargetKind::RLib) && !target.test {
            unbuilt += 1;
            files_with_tests(
                target.src_path.parent().expect("a folder").as_ref(),
                &mut found,
            );
        }
    }
    assert!(unbuilt > 0 && found.is_empty(), "`test = false`: {found:?}");
}
