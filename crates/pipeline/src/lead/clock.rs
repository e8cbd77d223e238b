//! The controller's steps of time. Nodes of leads lie on them, as all control points do.

/// Counts time in ticks: a controller's steps of time, or seconds where the controller has no
/// steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    steps: Option<f64>,
}

impl Clock {
    /// A clock of so many steps a second, or of seconds.
    pub fn new(steps: Option<f64>) -> Self {
        Self { steps }
    }

    fn per_second(&self) -> f64 {
        self.steps.unwrap_or(1.0)
    }

    /// The least ticks that take `seconds` or more.
    pub fn at_least(&self, seconds: f64) -> f64 {
        self.steps.map_or(seconds, |steps| (seconds * steps).ceil())
    }

    /// The ticks nearest to `seconds`.
    pub fn nearest(&self, seconds: f64) -> f64 {
        self.whole(seconds * self.per_second())
    }

    /// The nearest count of ticks that the clock can show.
    pub fn whole(&self, ticks: f64) -> f64 {
        self.steps.map_or(ticks, |_| ticks.round())
    }

    /// How long `ticks` take, s. Whole ticks stay exact in every sum, so that the same instant is the
    /// same double wherever it is computed.
    pub fn seconds(&self, ticks: f64) -> f64 {
        ticks / self.per_second()
    }
}
