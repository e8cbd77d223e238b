//! Pages: what is in them whatever the data are.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests may panic too"
)]

mod contents;
mod sizes;
mod support;
