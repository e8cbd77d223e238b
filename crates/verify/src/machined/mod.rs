//! The machined surface: the surface that the nose leaves along the played path, with interpolation
//! error and cusps together.
//!
//! The surface error is machined − wanted along z. At one angle the passes of the nose, with those
//! of the opposite half turn, are equal circles in one plane through the axis. The machined profile
//! is the lower envelope of their lower arcs ([`lower_envelope`]). Figures are computed along many
//! such lines ([`Lines`]), a profile along one line ([`ProfileLine`]), maps and circles point by
//! point ([`Map`]).

mod cusps;
mod envelope;
mod extremes;
mod figures;
mod form;
mod grid;
mod groups;
mod lines;
mod map;
mod no_height;
mod pieces;
mod profile;
mod rings;
mod samples;
mod sections;
mod spectrum;
mod strip;
mod turns;

pub use cusps::HighestCusp;
pub use envelope::{Arc, lower_envelope};
pub use extremes::{PartPoint, SurfaceExtremes};
pub use figures::MachinedFigures;
pub use form::FormScope;
pub use grid::{Grid, GridPoint};
pub use lines::Lines;
pub use map::{Map, Nose};
pub use profile::{ProfileLine, ProfilePoint};
pub use rings::ErrorRings;
pub use sections::{Fan, SectionPasses};
pub use spectrum::{SpectrumLine, power_spectrum};
