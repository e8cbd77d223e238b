//! Series through as few orders as a caller needs.
//!
//! A product of two series of slopes takes 75 multiplications through order 4, 30 through order 2
//! and 15 through order 1. The coefficients that are left have the same bits: see [`Taylor`](crate::Taylor).

use crate::ORDER;

/// The orders through which a caller needs the series of a surface, 4 at the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SeriesOrders {
    /// The order of the heights. It is at least that of the slopes.
    pub heights: usize,
    /// The order of the slopes.
    pub slopes: usize,
}

impl SeriesOrders {
    /// All orders.
    pub const ALL: Self = Self {
        heights: ORDER,
        slopes: ORDER,
    };
}
