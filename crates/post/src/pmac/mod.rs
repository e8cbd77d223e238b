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
//! The lines before the first mark belong to the header, those after the last mark to the footer.
//! The first move brings the axes from wherever they are to the first control point, within
//! [`ENTRY_MS`], and reaches the velocity of that point. If the path has a lead-in, that point is a
//! rest above the part. Every other move is a segment of the path. Sections follow each other without
//! a break, and each begins with a mark.
//!
//! **Times.** The controller counts times in 1/4096 ms. The writer rounds the time of each point since
//! the start of the path, not the time of each segment, so rounding errors do not add up. A point
//! between two such times moves along the played cubic to the nearer one (by 122 ns at the most) and
//! takes the velocity there. So the spindle keeps its speed from segment to segment, and the played
//! curve does not change. If the point kept its position and only its velocity were scaled, the curve
//! would bend on one side of the point, because rounding changes the lengths of the two segments
//! differently. (If the recipe asks for a program, the pipeline places the points at such times from
//! the start, so that the path and the program have the same points.)
//!
//! Facts on the language: Turbo PMAC Software Reference and User Manual, "PVT-Mode Moves".

mod commands;
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

pub use commands::{Command, commands, leaves_program_open};
pub use error::PmacError;
pub use format::{ENTRY_MS, PmacFormat, QUANTA_PER_S};
pub use program::{FOOTER, HEADER, PmacFileBody, PmacWriter};
pub use read::PmacReader;
pub use template::{PLACEHOLDERS, Template, TemplateError};
