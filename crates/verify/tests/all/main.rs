//! What `turnpath-verify` does from outside, each subject a module.

mod as_played;
mod common;
#[path = "../../../../tests/support/models.rs"]
mod models;
#[path = "../../../../tests/support/drop_cutter.rs"]
mod reference;

mod blocks;
mod comparison;
mod coverage;
mod cusps;
mod drop_cutter;
mod first_touch;
mod interpolation;
mod leads;
mod machined;
mod seams;
