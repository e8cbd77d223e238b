//! What `turnpath-grid` does from outside, each subject a module.

mod continuation;
mod parameters;
mod smoothing;
