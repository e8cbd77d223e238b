//! The rules of this repository: which crate and which file may use which, and pages that say what
//! is so.

#[path = "../support/mod.rs"]
mod support;

mod architecture;
mod circles;
mod pages;
mod reference_files;
mod unbuilt_tests;
mod workspace;
