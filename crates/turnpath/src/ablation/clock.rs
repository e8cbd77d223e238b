//! The time that a thread has worked, whatever else the machine does.

use std::sync::atomic::{AtomicU64, Ordering};

/// Tells the time that a run is measured from the time that its path is made.
#[derive(Debug, Default)]
pub struct MeasuringClock {
    /// When measuring began, s, as bits.
    begun: AtomicU64,
    /// How long it took so far, s, as bits.
    total: AtomicU64,
}

impl MeasuringClock {
    /// Measuring begins or ends. One thread at a time calls this.
    pub fn measures(&self, begins: bool) {
        let now = now();
        if begins {
            return self.begun.store(now.to_bits(), Ordering::Relaxed);
        }
        let begun = f64::from_bits(self.begun.load(Ordering::Relaxed));
        let total = self.total() + now - begun;
        self.total.store(total.to_bits(), Ordering::Relaxed);
    }

    /// The time that was measured so far, s.
    pub fn total(&self) -> f64 {
        f64::from_bits(self.total.load(Ordering::Relaxed))
    }
}

/// Processor time of this thread so far, s.
#[cfg(unix)]
pub fn now() -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Time since the first call, s: of the clock on the wall where there is no other.
#[cfg(not(unix))]
pub fn now() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static BEGAN: OnceLock<Instant> = OnceLock::new();
    BEGAN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
