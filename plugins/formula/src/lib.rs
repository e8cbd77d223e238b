//! The surface `formula`: z(x, y) as the recipe writes it.
//!
//! The text is read once. `parser` turns it into a `graph` in which every subexpression stands
//! once, and checks that the dimensions (`dimension`) fit. `polar` turns ρ and θ into x and y, such
//! that the axis is a point like any other. `tape` puts the graph into a list of steps, which runs
//! on every number type. `jump` refuses heights that jump where θ ends. `builder` makes a formula step
//! by step, without a text.

mod build_error;
mod builder;
mod complaint;
mod dimension;
mod formula;
mod gap;
mod graph;
mod jump;
mod lexer;
mod names;
mod parser;
mod polar;
mod run;
mod tape;

pub use build_error::BuildError;
pub use builder::{FormulaBuilder, Value};
pub use formula::Formula;

// Tests of this crate's own parts need no strategies, which take most of its compile time.
#[cfg(not(test))]
turnpath_plugin::export!(surfaces: [Formula]);
