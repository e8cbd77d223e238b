//! How many points the adapters handle at a time, in buffers on the stack.

use std::ops::Range;

use turnpath_core::{Result, StrategyError};

/// Points at a time. From 16 points on, a call across the plugin boundary costs nothing that can be
/// measured, and the buffers of 128 points fit into the first cache.
pub(super) const POINTS: usize = 128;

/// Curves at a time: each has five coefficients.
pub(super) const CURVES: usize = 64;

/// The ranges of at most `room` points each that make up a batch.
pub(super) fn ranges(count: usize, room: usize) -> impl Iterator<Item = Range<usize>> {
    let starts = (0..count).step_by(room);
    starts.map(move |start| start..count.min(start + room))
}

/// Refuses a batch whose slices differ in length.
pub(super) fn same_lengths<const N: usize>(points: usize, others: [usize; N]) -> Result<()> {
    match others.into_iter().find(|length| *length != points) {
        None => Ok(()),
        Some(length) => Err(StrategyError::failed(format!(
            "a batch of {points} points came with a slice of length {length}"
        ))),
    }
}
