//! Helpers of the whole-program tests.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

pub mod bench;
pub mod bench_with_plugins;
pub mod builds;
pub mod fixtures;
pub mod models;
pub mod recipe;

use std::path::{Path, PathBuf};

/// The repository's folder.
pub fn repository() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().expect("the repository").to_owned()
}
