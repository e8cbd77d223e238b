//! What the surface `formula` is held against: the native models, its own text, and random input.
#![allow(clippy::unwrap_used, reason = "an unwrap in a test is a failed test")]

mod axis;
mod common;
mod messages;
#[path = "../../../../tests/support/models.rs"]
mod models;
mod native;
mod random;
