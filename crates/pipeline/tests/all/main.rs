//! What `turnpath-pipeline` does from outside, each subject a module.

mod common;

mod answers;
mod blocks;
mod composites;
mod leads;
mod offsets;
mod passes;
mod refinement;
mod runs;
mod samples;
mod spindles;
