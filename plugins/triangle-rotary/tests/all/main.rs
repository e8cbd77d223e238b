//! What `turnpath-triangle-rotary` does from outside, each subject a module.

mod orders;
mod splines;
