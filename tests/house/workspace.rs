//! What cargo knows of the workspace.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use cargo_metadata::{Metadata, MetadataCommand};

/// The packages of the workspace with their targets and dependencies.
pub fn workspace() -> Metadata {
    MetadataCommand::new()
        .cargo_path(env!("CARGO"))
        .manifest_path(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata")
}
