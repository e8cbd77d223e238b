//! What the whole-program tests share.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

pub mod bench;
pub mod builds;
pub mod fixtures;
pub mod recipe;
