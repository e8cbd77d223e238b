//! What `turnpath-minimax` does from outside, each subject a module.

mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;

mod borders;
mod held;
mod motion;
mod points;
