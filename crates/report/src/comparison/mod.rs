//! The runs of an ablation side by side: columns of figures, as CSV and as a table.

mod all_columns;
mod cells;
mod column;
mod csv_table;
mod labels;
mod order;
mod paper_table;
mod table;
#[cfg(test)]
mod tests;
mod wording;

pub use all_columns::{all, by_name, names, usual};
pub use column::{Best, Column, Form, NOISE};
pub use csv_table::csv_table;
pub use order::sorted;
pub use paper_table::{Language, paper_table};
pub use table::table;
