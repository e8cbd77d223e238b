//! What `turnpath-ats` does from outside, each subject a module.

#[path = "../../../../tests/support/planned.rs"]
mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;
#[path = "../../../../tests/support/random.rs"]
mod random;

mod large_feeds;
mod laws;
mod sampler;
