//! What `turnpath-integrated` does from outside, each subject a module.

mod arcs;
mod derived_step;
mod equal_angle;
#[path = "../../../../tests/support/models.rs"]
mod models;
