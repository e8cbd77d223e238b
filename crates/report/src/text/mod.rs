//! Reports as text for a terminal.

mod check;
mod coverage;
mod file;
mod form;
mod lead;
mod machine;
mod numbers;
mod path;
mod run;
mod servo;
mod tool_fit;
mod unreached;

pub use check::check;
pub use file::file;
pub use numbers::{grouped, millimetres, nose_radius};
pub use run::run;
