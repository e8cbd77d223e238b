//! What `turnpath-recipe` does from outside, each subject a module.

mod common;

mod ablation_messages;
mod arbitrary;
mod messages;
mod recipes;
mod sums;
