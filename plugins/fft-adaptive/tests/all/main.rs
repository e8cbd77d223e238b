//! What `turnpath-fft-adaptive` does from outside, each subject a module.

#[path = "../../../../tests/support/planned.rs"]
mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;
#[path = "../../../../tests/support/random.rs"]
mod random;

mod laws;
mod sampler;
