//! What `turnpath-pipeline` does from outside, each subject a module.

mod common;

mod answers;
mod blocks;
mod leads;
mod refinement;
mod runs;
