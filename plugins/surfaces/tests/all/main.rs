//! What `turnpath-surfaces` does from outside, each subject a module.

mod against_reference;
mod design_programs;
mod geometry_and_parameters;
#[path = "../../../../tests/support/models.rs"]
mod models;
