//! Figures for papers: what a run gave, as SVG and as PNG, in millimetres of the page.
//!
//! [`draw`] makes a [`Drawing`] of a run's report and of the sketch that its page has. The letters of a
//! drawing are outlines of one font that is part of this crate, so it looks the same everywhere. The
//! same data give the same bytes.

mod colours;
mod drawing;
mod figures;
mod frame;
mod letters;
mod png_file;
mod range;
mod request;
mod series;
mod shape;
mod sheet;
mod square;
mod stack;
mod svg_file;

pub use drawing::Drawing;
pub use figures::draw;
pub use request::{Dots, DrawingError, Figure, Size};
