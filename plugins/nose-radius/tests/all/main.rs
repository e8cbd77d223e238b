//! What `turnpath-nose-radius` does from outside, each subject a module.

mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;
#[path = "../../../../tests/support/drop_cutter.rs"]
mod reference;

mod closed_forms;
mod drop_cutter;
mod interference;
mod series;
mod touch;
