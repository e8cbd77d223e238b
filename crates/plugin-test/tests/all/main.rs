//! What `turnpath-plugin-test` finds, and what passes.

mod built_ins;
mod faults;
mod fixtures;
