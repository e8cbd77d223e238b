//! What turnpath does with bytes from outside, as functions that cargo-fuzz calls and that the tests
//! call too. Each takes any bytes. It panics only where turnpath is wrong: where turnpath itself
//! panics, or where an answer contradicts what its crate promises.
//!
//! The fuzzer itself is not used here, so that every compiler can build these functions.
#![allow(
    clippy::expect_used,
    reason = "a target panics where an answer is wrong"
)]

pub mod csv;
pub mod formula;
pub mod lens;
pub mod library;
pub mod map;
pub mod pmac;
mod points;
pub mod recipe;
pub mod report;
pub mod template;

/// A function that takes bytes from outside.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name, and that of its folder in `corpus`.
    pub name: &'static str,
    /// The function.
    pub read: fn(&[u8]),
    /// Words that its inputs are made of.
    pub words: &'static [&'static str],
}

/// All targets.
pub const TARGETS: [Target; 9] = [
    Target {
        name: "recipe",
        read: recipe::read,
        words: recipe::WORDS,
    },
    Target {
        name: "csv",
        read: csv::read,
        words: csv::WORDS,
    },
    Target {
        name: "formula",
        read: formula::read,
        words: formula::WORDS,
    },
    Target {
        name: "pmac",
        read: pmac::read,
        words: pmac::WORDS,
    },
    Target {
        name: "template",
        read: template::read,
        words: template::WORDS,
    },
    Target {
        name: "lens",
        read: lens::read,
        words: lens::WORDS,
    },
    Target {
        name: "library",
        read: library::read,
        words: library::WORDS,
    },
    Target {
        name: "map",
        read: map::read,
        words: map::WORDS,
    },
    Target {
        name: "report",
        read: report::read,
        words: report::WORDS,
    },
];
