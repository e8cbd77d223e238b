//! `[passes]`: the fixed key of its tables, one for each path before the finishing one.

use turnpath_core::Param;
use turnpath_core::kind::Length;

use crate::read::Section;
use crate::table_info::TableInfo;

/// The table of all rough paths.
pub(crate) const PASSES_TABLE: &str = "passes";

const ALLOWANCE: Param<Length> = Param::length(
    "allowance",
    "what the path leaves on the wanted surface, along z",
)
.positive()
.example("30 um");

pub(super) const PASSES: TableInfo = TableInfo {
    name: PASSES_TABLE,
    summary: "the paths before the finishing one, a table `[passes.NAME]` for each",
    required: false,
    keys: &[ALLOWANCE.info()],
};

/// The name of the fixed key.
pub(crate) fn allowance_key() -> impl Iterator<Item = &'static str> {
    PASSES.names()
}

/// Reads what a rough path leaves, mm; `None` if the value is wrong.
pub(crate) fn allowance(section: &mut Section<'_>) -> Option<f64> {
    section.values(PASSES.keys).find(ALLOWANCE)
}
