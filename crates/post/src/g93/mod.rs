//! Programs of straight lines with `G93`: positions and times, and no velocities.
//!
//! ```text
//! ; -- cutting --
//! G8 G21 G40 G64 G90 G93
//! G1 C0 X2.5 Z1.5 F60
//! C0.75 X2.4999499 Z1.5128 F240000
//! C1.5 X2.4998998 Z1.5256 F240000
//! …
//! ; -- end of path: 33280 points --
//! ```
//!
//! The controller moves all axes linearly in time from one position to the next. So a program has a
//! point for each chord of the path's cubics, and `carry` places them. F is one over the minutes of a
//! line, or its seconds. Times are in steps of a nanosecond, and the time since the start is rounded,
//! so that rounding errors do not add up.
//!
//! Before and after the path the feed is per minute: `G94`. So the first line of a path says `G93` again.
//!
//! The first line brings the axes from wherever they are to the first control point, within a second.

mod beckhoff;
mod depth_lines;
mod depth_loop;
mod linuxcnc;
mod nanotech;
mod read;
#[cfg(test)]
mod tests;
mod timing;
mod write;

pub(crate) use beckhoff::BECKHOFF_G93;
pub(crate) use linuxcnc::LINUXCNC_G93;
pub(crate) use nanotech::NANOTECH_G93;
