//! What `turnpath-polynomials` does from outside, each subject a module.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod beyond_the_aperture;
mod common;
mod conventions;
#[path = "../../../../tests/support/models.rs"]
mod models;
mod parameters;
