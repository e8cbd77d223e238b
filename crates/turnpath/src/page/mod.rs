//! `report.html`: its data from a recipe and its path.

mod chain;
mod of_run;
mod remake;
mod request;
mod sketch;
mod surface;

pub use of_run::page_of_run;
pub use remake::{result_recipe, write_page};
pub use request::{PageError, PageRequest};
pub use sketch::{error_sketch, path_sketch};
