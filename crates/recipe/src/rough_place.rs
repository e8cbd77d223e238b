//! The place of a rough path among the paths of its run.

/// What the recipe of a rough path knows of itself.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RoughPlace {
    /// The path's name.
    pub(crate) name: String,
    /// What it leaves on the wanted surface, along z, mm.
    pub(crate) allowance: f64,
    /// Its number among the rough paths, from 1.
    pub(crate) number: u32,
}
