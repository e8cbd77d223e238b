//! The surface of a recipe on a grid, and against a map.

mod against;
mod grid;
mod grid_file;

pub use against::{MapSource, compare_with_map};
pub use grid::{SagGaps, write_sag, write_sag_to};
