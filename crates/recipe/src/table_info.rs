//! The declaration of a table that belongs to no strategy.

use turnpath_core::ParamInfo;

/// The declaration of a table that belongs to no strategy: its keys, declared like the parameters of
/// a strategy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableInfo {
    /// The table's name, `tool` or `output.pmac-pvt`; empty for the keys above the first table.
    pub name: &'static str,
    /// One line that says what the table is about.
    pub summary: &'static str,
    /// Whether a recipe must have the table.
    pub required: bool,
    /// The keys.
    pub keys: &'static [ParamInfo],
}

impl TableInfo {
    /// Whether the table has this key.
    pub fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|info| info.name == key)
    }

    /// The names of the keys.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.keys.iter().map(|info| info.name)
    }
}
