//! The machined surface: what the nose leaves on the played path, interpolation error and cusps
//! together.
//!
//! Surface error is machined − wanted along z. At one angle the passes of the nose are equal
//! circles in one plane through the axis, those of the opposite half turn included; the machined
//! profile is the lower envelope of their lower arcs ([`lower_envelope`]). Figures are taken along
//! many such lines ([`Lines`]), profiles along one; maps and circles place by place ([`Map`]).

mod envelope;
mod figures;
mod grid;
mod map;
mod profile;
mod sections;
mod spectrum;
mod strip;
mod turns;

pub use envelope::{Arc, lower_envelope};
pub use figures::{MachinedFigures, PlaceOnPart};
pub use grid::{Grid, Place};
pub use map::{Map, Nose};
pub use profile::{ProfileLine, ProfilePlace};
pub use sections::{Fan, Lines, SectionPasses};
pub use spectrum::{SpectrumLine, power_spectrum};
