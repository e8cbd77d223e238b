//! Motion programs for Turbo PMAC in position-velocity-time mode, and the reader that checks them.
//!
//! ```text
//! ; -- cutting --
//! ABS
//! PVT1000
//! C0:3000 X2.5:-0.2003846 Z1.5:0
//! PVT3
//! C9:3000 X2.4993989:-0.2003846 Z1.6544085:50.3013247
//! …
//! ; -- end of path: 4160 points --
//! ```
//!
//! What stands before the first mark and behind the last is the header's and the footer's, and
//! not the path's. The first move brings the axes to the first control point at its velocity, from
//! where they stand, within [`ENTRY_MS`]: to rest above the part where the path has a lead-in.
//! Every other one is a segment of the path. Sections follow one another without a break; a mark
//! stands before each.
//!
//! **Times.** The controller counts times in 1/4096 ms. The time of each point since the path's
//! start is rounded, not the segment's, so nothing adds up; and a point that does not lie on such a
//! time moves along the played cubic to it (122 ns at the most), with its velocity there. (The
//! pipeline puts its points on such times beforehand when a program is asked for, so that the
//! path and the program have the same points.) So the spindle
//! keeps its speed from segment to segment, and the played curve stays where it was. Leaving the
//! point in its place and scaling its velocity would bend the curve on one side of it, because the
//! two segments that meet there are not stretched alike.
//!
//! Facts on the language: Turbo PMAC Software Reference and User Manual, "PVT-Mode Moves".

mod decimal;
mod encode;
mod error;
mod format;
mod program;
mod read;
mod scan;
mod template;
#[cfg(test)]
mod tests;

pub use error::PmacError;
pub use format::{ENTRY_MS, PmacFormat, QUANTA_PER_S};
pub use program::{FOOTER, HEADER, PmacWriter};
pub use read::PmacReader;
pub use template::{PLACEHOLDERS, Template, TemplateError};
