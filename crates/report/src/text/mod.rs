//! Reports as text for a terminal.

mod anomalies;
mod axis_notes;
mod check;
mod commands;
mod coverage;
mod file;
mod form;
mod lead;
mod machine;
mod map_comparison;
mod numbers;
mod part_shape;
mod path;
mod remark;
mod rough_path;
mod run;
mod servo;
mod tool_fit;
mod unreached;
mod warnings;

pub use check::check;
pub use file::file;
pub use map_comparison::map_comparison;
pub use numbers::{bytes, grouped, limit_amount, limit_name, millimetres, nose_radius};
pub use part_shape::refused_check;
pub use run::{run, verified_figures};
pub use warnings::warnings;
