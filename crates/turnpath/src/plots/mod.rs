//! Maps, profiles, circles and spectra of the machined surface: what is asked for, where each file
//! goes, and how it is drawn.

mod draw;
mod files;
mod request;

pub use draw::{PlayedPath, draw};
pub use files::{Plots, can_be_made, make_folder, place_of};
pub use request::{GRID_POINTS, MapGrid, MapRequest, PlotError, PlotRequest, check_grid};
