//! Brackets: intervals of contacts that each hold one maximum of the nose's height.

/// An interval of contacts around one maximum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    /// Index of the (θ, X) that it belongs to.
    pub point: usize,
    /// Lower end, mm.
    pub low: f64,
    /// Upper end, mm.
    pub high: f64,
    /// A radius in it at which the surface has a height, mm.
    pub start: f64,
}
