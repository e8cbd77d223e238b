//! Files that are whole or not there.

mod registry;

pub use registry::{DraftKind, Registration, remove_drafts};
