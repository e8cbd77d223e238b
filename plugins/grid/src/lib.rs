//! The surface model `grid-sag`: a spline through the heights of a map.
//!
//! [`surface`](GridSag) reads the map. Then each step has a file of its own:
//!
//! 1. `trend`: the quadratic of best fit is taken away, so that what follows works on what is
//!    left, and added again at the end.
//! 2. `low_pass`: with `smooth`, what is shorter than the cutoff is removed by a `gaussian`, and by `planes` at edges
//!    and beside holes, after `blocks` of points were averaged where a map is much finer.
//! 3. `bending`: holes, and a margin around the map, are filled so that the bend of a `plate` changes
//!    least.
//! 4. `interpolation`: the coefficients of a tensor B-spline of degree 5 through all points.
//! 5. `edges`: where the map is smooth, its own spline counts up to its edge.
//! 6. `spline`: the coefficients, and those that count at a place; `continuation`: those beyond the map.
//! 7. `points` and `taylor`: values and slopes, and series along curves. A `group` of places goes through the
//!    registers together.

#[cfg(test)]
mod against_scipy;
mod banded;
mod basis;
mod bending;
mod blocks;
mod cells;
mod continuation;
mod differences;
mod edges;
mod gaussian;
mod group;
mod interpolation;
mod low_pass;
mod planes;
mod plate;
mod plate_edge;
mod points;
mod sheet;
mod spline;
mod surface;
mod taylor;
mod trend;

pub use surface::GridSag;

turnpath_plugin::export!(surface_models: [GridSag]);
