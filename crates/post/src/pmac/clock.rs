//! How a controller of this family counts the time of a segment.

/// Times of segments in the text, and their steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Clock {
    /// Steps in a millisecond.
    pub(crate) steps_per_ms: i64,
    /// Decimals of milliseconds with which every step is exact.
    pub(crate) decimals: u32,
}

impl Clock {
    /// A step of time in units of the last decimal.
    pub(crate) fn step(self) -> i64 {
        10i64.pow(self.decimals) / self.steps_per_ms
    }
}
