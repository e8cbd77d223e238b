//! The error that comes back at the same angles turn after turn.

use serde::{Deserialize, Serialize};

use crate::unit;

/// The largest spoke: a harmonic of machined − wanted, averaged over the turns of a band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spokes {
    /// Amplitude of the harmonic, mm: half its peak to valley.
    #[serde(rename = "amplitude_nm", with = "unit::nm")]
    pub amplitude: f64,
    /// Its periods on a turn.
    pub per_turn: usize,
    /// The smallest radius of its band, mm.
    #[serde(rename = "from_mm", with = "unit::mm")]
    pub from: f64,
    /// The largest, mm.
    #[serde(rename = "to_mm", with = "unit::mm")]
    pub to: f64,
}
