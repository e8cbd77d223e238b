//! No two source files of a crate import each other, neither directly nor over others.
//!
//! A file imports another where a `use` or a path in its code leads to an item that the other file
//! defines. A re-export counts as the file that defines the item: `lib.rs` and `mod.rs` may pass
//! their children's items on, and the children may take each other's from there. Whatever stands
//! under `#[cfg(test)]` is left out, since a unit test may use what is built on its file.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

mod crate_files;
mod graph;
mod module;
mod resolve;
mod tokens;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::TargetKind;
use crate_files::CrateFiles;
use graph::circles;
use resolve::imports;

use crate::workspace::workspace;

/// The circles of a crate, each as a message; paths are shown from `base` on.
fn circles_of(root: &Path, base: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Vec<String> {
    let files = CrateFiles::read(root, read);
    let imports = imports(&files);
    let shown = |file: usize| {
        let path = &files.paths[file];
        path.strip_prefix(base).unwrap_or(path).display()
    };
    let message = |circle: Vec<usize>| {
        let inside = imports
            .iter()
            .filter(|(ends, _)| circle.contains(&ends.0) && circle.contains(&ends.1));
        let lines: Vec<String> = inside
            .map(|(&(from, to), import)| {
                let line = import.line;
                format!(
                    "  {}:{line} takes `{}` of {}",
                    shown(from),
                    import.path,
                    shown(to)
                )
            })
            .collect();
        format!("{} files in a circle:\n{}", circle.len(), lines.join("\n"))
    };
    let pairs: Vec<(usize, usize)> = imports.keys().copied().collect();
    let found = circles(files.paths.len(), &pairs);
    found.into_iter().map(message).collect()
}

/// The circles of a crate whose files are given as text; `src/lib.rs` is its root.
fn circles_in(files: &[(&str, &str)]) -> Vec<String> {
    let texts: BTreeMap<PathBuf, &str> = files
        .iter()
        .map(|(path, text)| (PathBuf::from(path), *text))
        .collect();
    let read = |path: &Path| texts.get(path).map(|text| (*text).to_owned());
    circles_of(Path::new("src/lib.rs"), Path::new(""), &read)
}

#[test]
fn no_files_of_a_crate_import_each_other() {
    let metadata = workspace();
    let base = fs::canonicalize(&metadata.workspace_root).expect("the workspace");
    let read = |path: &Path| fs::read_to_string(path).ok();
    let (mut crates, mut found) = (0, Vec::new());
    for package in &metadata.packages {
        let targets = package.targets.iter();
        for target in targets.filter(|target| !target.kind.contains(&TargetKind::CustomBuild)) {
            let root = fs::canonicalize(&target.src_path).expect("the crate's root");
            let circles = circles_of(&root, &base, &read);
            let named = |circle| format!("{}, {}: {circle}", package.name, target.name);
            found.extend(circles.into_iter().map(named));
            crates += 1;
        }
    }
    assert!(crates > 30, "only {crates} crates were read");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn two_files_that_import_each_other_are_found_with_their_lines() {
    let found = circles_in(&[
        ("src/lib.rs", "mod a;\nmod b;\n"),
        (
            "src/a.rs",
            "use crate::b::Second;\npub struct First(Second);\n",
        ),
        (
            "src/b.rs",
            "pub struct Second;\n\nfn f(_: &super::a::First) {}\n",
        ),
    ]);
    let expected = "2 files in a circle:\n  src/a.rs:1 takes `crate::b::Second` of src/b.rs\n  \
                    src/b.rs:3 takes `super::a::First` of src/a.rs";
    assert_eq!(found, [expected]);
}

#[test]
fn a_circle_over_three_files_is_found() {
    let found = circles_in(&[
        ("src/lib.rs", "mod a; mod b; mod c; mod d;"),
        (
            "src/a.rs",
            "use crate::{b::{B, Other as Renamed}, d::D}; pub struct A;",
        ),
        (
            "src/b.rs",
            "use super::c; pub struct B(c::C); pub struct Other;",
        ),
        ("src/c/mod.rs", "mod inner; pub use inner::C;"),
        ("src/c/inner.rs", "use crate::a::A; pub struct C(A);"),
        ("src/d.rs", "pub struct D;"),
    ]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("3 files"), "{found:?}");
    assert!(
        found[0].contains("src/b.rs:1 takes `c::C` of src/c/inner.rs"),
        "{found:?}"
    );
}

#[test]
fn a_parent_that_uses_its_child_and_defines_what_the_child_takes_is_a_circle() {
    let child = (
        "src/a/child.rs",
        "use super::Shared; pub struct Child(Shared);",
    );
    let parent = "mod child; pub struct Shared; pub struct Whole(child::Child);";
    let found = circles_in(&[("src/lib.rs", "mod a;"), ("src/a.rs", parent), child]);
    assert_eq!(found.len(), 1, "{found:?}");
    let parent = "mod child; pub use child::Child; pub struct Shared; pub fn f(_: Child) {}";
    let found = circles_in(&[("src/lib.rs", "mod a;"), ("src/a/mod.rs", parent), child]);
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn re_exports_and_globs_count_as_the_file_that_defines_the_item() {
    let found = circles_in(&[
        ("src/lib.rs", "mod a; mod b; pub use a::A; pub use b::*;"),
        ("src/a.rs", "use crate::B; pub struct A(B);"),
        ("src/b.rs", "pub struct B;"),
    ]);
    assert_eq!(found, Vec::<String>::new());
    let found = circles_in(&[
        ("src/lib.rs", "mod a; mod b; pub use a::A; pub use b::*;"),
        ("src/a.rs", "use crate::B; pub struct A(B);"),
        ("src/b.rs", "use super::*; pub struct B; fn f(_: A) {}"),
    ]);
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn comments_texts_and_unit_tests_import_nothing() {
    let found = circles_in(&[
        ("src/lib.rs", "mod a; mod b;"),
        ("src/a.rs", "use crate::b::B; pub struct A(B);"),
        (
            "src/b.rs",
            "//! crate::a::A\n/* use crate::a::A; /* nested */ */ pub struct B;\n\
             pub const S: &str = \"crate::a::A\"; pub const R: &str = r#\"crate::a::A \"#;\n\
             pub fn f<'a>(c: &'a char) -> bool { *c == '\"' || *c == '\\'' }\n\
             #[cfg(test)]\nuse crate::a::A;\n#[cfg(test)]\nmod tests { use crate::a::A; }",
        ),
    ]);
    assert_eq!(found, Vec::<String>::new());
}
