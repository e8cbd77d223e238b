//! What `turnpath-atpg` does from outside, each subject a module.

mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;
#[path = "../../../../tests/support/random.rs"]
mod random;

mod changing_speed;
mod estimates;
mod laws;
mod sampler;
