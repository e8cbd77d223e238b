//! The tables of a recipe that belong to no strategy: their keys, and how each table is read.

mod ablation;
mod cutting;
mod machine;
mod output;
mod passes;
mod path;
mod pose;
mod post;
mod schema;
mod servo;
mod slot;
mod strategy;
mod surface;
#[cfg(test)]
mod tests;
mod top;
mod work;

pub use cutting::AskedTolerances;
pub use output::{DataFormat, Output, ZReference};
pub use post::PostSettings;
pub use slot::slot_keys;

pub(crate) use ablation::is_one_at_a_time;
pub(crate) use cutting::{DEFAULT_SPINDLE, check_servo_tolerance, spindle, tolerance};
pub(crate) use machine::{check_spindle, machine};
pub(crate) use output::output;
pub(crate) use passes::{PASSES_TABLE, allowance, allowance_key};
pub(crate) use path::path;
pub(crate) use pose::pose;
pub(crate) use post::post_settings;
pub(crate) use schema::SCHEMA;
pub(crate) use servo::servo;
pub(crate) use strategy::USE;
pub(crate) use surface::placement;
pub(crate) use top::{TOP, format_is_one, may_list_plugins, top};
pub(crate) use work::{part, tool};

use crate::table_info::TableInfo;

/// The tables that belong to no strategy: first the keys above the first table, under an empty name.
pub fn tables() -> impl Iterator<Item = &'static TableInfo> {
    std::iter::once(&TOP).chain(SCHEMA)
}
