//! A program of its own: `remove_drafts` removes the drafts of the whole process.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::fs;

use turnpath_files::{DraftKind, Registration, remove_drafts};

#[test]
fn what_is_registered_goes_and_what_was_withdrawn_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("a/b/c")).unwrap();
    for name in ["a/b/c/draft", "a/claim", "named"] {
        fs::write(path(name), "").unwrap();
    }
    let named = Registration::new(DraftKind::File, &path("named"));
    let entries = [
        (DraftKind::Folder, "a"),
        (DraftKind::Claim, "a/claim"),
        (DraftKind::File, "a/b/c/draft"),
        (DraftKind::File, "not there"),
        (DraftKind::Folder, "a/b/c"),
        (DraftKind::Folder, "a/b"),
    ];
    let entries = entries.map(|(kind, name)| Registration::new(kind, &path(name)));
    assert!(named.withdraw());
    remove_drafts();
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
    assert!(path("named").exists());
    assert!(entries.into_iter().all(|entry| !entry.withdraw()));
    // A folder that something else has come into stays, and places are free again.
    for _ in 0..1000 {
        assert!(Registration::new(DraftKind::File, &path("named")).withdraw());
    }
    fs::create_dir(path("full")).unwrap();
    fs::write(path("full/foreign"), "").unwrap();
    let full = Registration::new(DraftKind::Folder, &path("full"));
    remove_drafts();
    assert!(path("full/foreign").exists() && !full.withdraw());
}
