//! What the host asks of every law. A strategy that knows it can refuse with a reason of its own.

use crate::{RadialRange, Task};

/// Most revolutions of a path: two weeks at 500 rpm.
pub const MOST_REVOLUTIONS: f64 = 1e7;
/// Most pieces of a law, which take half a gigabyte. They suffice for some pieces in each of 100,000
/// revolutions.
pub const MOST_PIECES: usize = 8_000_000;
/// The spindle is steady over so many revolutions at either end of the path, where leads join it.
pub const STEADY_REVOLUTIONS: f64 = 0.5;

/// How far a law may go beyond the range of its task on either side, mm: so far that no surface is to be expected
/// there.
pub fn room_beyond(task: &Task) -> f64 {
    let RadialRange { inner, outer } = task.range;
    outer - inner + 2.0 * task.tool.nose_radius
}
