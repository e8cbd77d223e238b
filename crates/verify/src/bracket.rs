//! Brackets: intervals of contacts that each hold one maximum of the nose's height.

use turnpath_core::Tool;

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

impl Bracket {
    /// The whole reach of the tool at each X.
    pub fn of_reach(tool: &Tool, x: &[f64]) -> Vec<Self> {
        let reach = tool.reach();
        let around = |(point, x): (usize, &f64)| Self {
            point,
            low: x - reach,
            high: x + reach,
            start: *x,
        };
        x.iter().enumerate().map(around).collect()
    }
}
