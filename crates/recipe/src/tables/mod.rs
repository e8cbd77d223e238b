//! The tables of a recipe that belong to no strategy: their keys, and how each table is read.

mod cutting;
mod machine;
mod output;
mod path;
mod pmac_pvt;
mod schema;
mod servo;
#[cfg(test)]
mod tests;
mod top;
mod work;

pub use output::{DataFormat, Output, ZReference};
pub use pmac_pvt::PmacPvt;

pub(crate) use cutting::{spindle, tolerance};
pub(crate) use machine::{check_spindle, machine};
pub(crate) use output::output;
pub(crate) use path::path;
pub(crate) use pmac_pvt::pmac_pvt;
pub(crate) use schema::SCHEMA;
pub(crate) use servo::servo;
pub(crate) use top::{KEYS as TOP_KEYS, format_is_one, top};
pub(crate) use work::{part, tool};
