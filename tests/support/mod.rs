//! What the whole-program tests share.
#![allow(dead_code)] // each test uses what it needs

pub mod bench;
pub mod builds;
pub mod fixtures;
pub mod recipe;
