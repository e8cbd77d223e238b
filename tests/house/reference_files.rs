//! Each file of reference figures says which script and which packages made it.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::support::repository;

/// Folders and files that do not say it yet, below `tests/reference`. Those up to `recorded-figures.json` have figures of
/// turnpath's own paths, which `cargo xtask reference` makes again.
const WITHOUT: [&str; 8] = [
    "playback/",
    "pmac/",
    "rims/",
    "spokes/",
    "recorded-figures.json",
    "compensators.json",
    "dropcutter.json",
    "surfaces.json",
];

#[test]
fn each_reference_file_names_its_script_and_its_packages() {
    let root = repository().join("tests/reference");
    let mut files = Vec::new();
    gather(&root, &mut files);
    let mut checked = 0;
    for file in &files {
        let name = file.strip_prefix(&root).unwrap().to_string_lossy();
        let name = name.replace('\\', "/");
        let text = fs::read_to_string(file).unwrap();
        let made: Value = serde_json::from_str(&text).unwrap();
        let made = &made["made_by"];
        if WITHOUT.iter().any(|without| name.starts_with(without)) {
            assert!(made.is_null(), "{name} is to leave the list: it says it");
            continue;
        }
        let script = made["script"].as_str();
        let script = script.unwrap_or_else(|| panic!("{name} does not name its script"));
        assert!(repository().join(script).is_file(), "{name}: {script}");
        let packages = made["packages"].as_str();
        let packages = packages.unwrap_or_else(|| panic!("{name} does not name its packages"));
        for package in packages.split(", ") {
            let version = package.split(' ').nth(1);
            let is_version =
                version.is_some_and(|one| one.starts_with(|c: char| c.is_ascii_digit()));
            assert!(is_version, "{name}: {package}");
        }
        checked += 1;
    }
    assert!(checked >= 10, "{checked}");
}

fn gather(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            gather(&path, found);
        } else if path.extension().is_some_and(|end| end == "json") {
            found.push(path);
        }
    }
}
