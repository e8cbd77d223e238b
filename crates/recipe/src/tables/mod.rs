//! The tables of a recipe that are not a strategy's: their keys, and how each is read.

mod cutting;
mod machine;
mod output;
mod path;
mod pmac_pvt;
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
pub(crate) use servo::servo;
pub(crate) use top::{KEYS as TOP_KEYS, format_is_one, top};
pub(crate) use work::{part, tool};

/// The tables with fixed keys.
pub(crate) const SCHEMA: &[(&str, &[&str])] = &[
    ("part", work::PART_KEYS),
    ("tool", work::TOOL_KEYS),
    ("tolerance", cutting::TOLERANCE_KEYS),
    ("spindle", cutting::SPINDLE_KEYS),
    ("path", path::KEYS),
    ("output", output::KEYS),
    (pmac_pvt::NAME, pmac_pvt::KEYS),
    ("machine", machine::KEYS),
    ("servo", servo::KEYS),
    ("ablation", &["mode"]),
];
