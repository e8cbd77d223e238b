//! Measures what a tool path cuts, apart from whatever made the path.
//!
//! The true tool position is found here, by the first touch of the nose on the surface; a
//! compensator is never asked. A path comes in stretches of neighbouring control points
//! ([`Meter::measure`], in parallel), whose measures are put together in order
//! ([`Meter::append`]): the figures do not depend on how many threads there were.

mod axes;
mod closing;
mod corners;
mod coverage;
mod cusp;
mod lead;
mod limits;
pub mod machined;
mod meter;
mod periodogram;
mod playback;
mod points;
mod profiles;
mod residual;
mod scan;
mod servo;
mod spectrum;
mod steep;
mod subject;
mod suspects;
mod touch;
mod unreached;

pub use axes::{AxesMotion, AxisMotion, Peak};
pub use coverage::{CoverageFigures, Uncut};
pub use lead::{Jumps, LeadFigures, LeadMeter, LeadStretch};
pub use limits::{HighestSpeed, LimitFigure};
pub use meter::{Measured, Meter, PathFigures};
pub use playback::{INSTANTS, PlaybackFigures};
pub use points::PointFigures;
pub use residual::{ResidualFigures, SECTIONS, cusp_heights};
pub use servo::{Following, ServoFigures, ServoMeter, ServoStart, ServoStretch};
pub use spectrum::{AxesLine, AxesSpectrum};
pub use subject::Subject;
pub use suspects::{Oddity, Suspect, Suspects};
pub use touch::{FirstTouch, Touch};
pub use unreached::{Ride, UnreachedFigures, rides, unreached};
