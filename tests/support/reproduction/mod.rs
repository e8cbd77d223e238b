//! What makes docs/reproduction.md: the list of figures, the runs that they need, the page.

pub mod data;
pub mod markdown;
pub mod runs;
