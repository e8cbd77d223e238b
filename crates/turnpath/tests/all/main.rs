//! The library from outside, without the program: outputs, cancellation, and reports as files.

mod support;

mod cancellation;
mod errors;
mod outputs;
mod own_strategies;
mod pages;
mod reports;
