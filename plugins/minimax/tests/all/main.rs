//! What `turnpath-minimax` does from outside, each subject a module.

mod common;

mod borders;
mod held;
mod motion;
mod points;
