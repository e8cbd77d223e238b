//! The spindle strategy: it decides how fast the spindle turns along the path.

use crate::{Path, Result, SpindleLaw};

/// What the host asks of a spindle strategy.
#[derive(Debug, Clone, Copy)]
pub struct SpindleAsk<'a> {
    /// The largest speed, rad/s.
    pub speed: f64,
    /// For each half turn from N = 0 on: the part of `speed` at which the axes as played keep to the
    /// machine's limits, above 0 and at most 1. The list is empty in the first call.
    pub factors: &'a [f64],
}

/// Plans the speed of the spindle along a whole path.
pub trait SpindleStrategy: Send + Sync {
    /// The spindle law of the path. `path.spindle` is the law of the constant speed `ask.speed`.
    ///
    /// The law covers the path: t grows with N from t(0) = 0, and t, dt/dN and d²t/dN² are
    /// continuous. The speed never exceeds `ask.speed`, and it is constant over the first and over
    /// the last half turn, so that the leads join a steady spindle. The host checks all of this.
    /// The limits of the machine are in `path.task.machine`.
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw>;

    /// Whether the strategy uses [`SpindleAsk::factors`]. If it does, the host plays the path back
    /// and asks again, three times at most. The default is false.
    fn follows_factors(&self) -> bool {
        false
    }
}
