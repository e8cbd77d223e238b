//! Counts of a process's work, for benchmarks: a run that does less is not a faster one.
//!
//! A count grows once for each batch, so that it costs nothing that can be measured.

use std::sync::atomic::{AtomicU64, Ordering};

/// Positions at which the part stopped the tool.
pub static FIRST_TOUCHES: Tally = Tally::new("first touches");
/// Instants at which a played path was compared with its first touch.
pub static INSTANTS: Tally = Tally::new("instants");
/// Series of the tool locus along curves.
pub static SERIES: Tally = Tally::new("series");
/// Lines of motion programs that were read back.
pub static LINES_READ: Tally = Tally::new("lines read");

/// All of them.
pub static TALLIES: [&Tally; 4] = [&FIRST_TOUCHES, &INSTANTS, &SERIES, &LINES_READ];

/// A count of the whole process.
#[derive(Debug)]
pub struct Tally {
    /// What is counted, in the plural.
    pub what: &'static str,
    count: AtomicU64,
}

impl Tally {
    const fn new(what: &'static str) -> Self {
        let count = AtomicU64::new(0);
        Self { what, count }
    }

    /// Counts a batch.
    pub fn add(&self, batch: usize) {
        self.count.fetch_add(batch as u64, Ordering::Relaxed);
    }

    /// The count so far.
    pub fn total(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }
}
