//! The error that comes back turn after turn: at the same angles, or a little further on.

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

/// The largest spiral arms: a harmonic of machined − wanted that turns evenly over the turns of a band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Arms {
    /// Amplitude of the pattern, mm: half its peak to valley.
    #[serde(rename = "amplitude_nm", with = "unit::nm")]
    pub amplitude: f64,
    /// Arms: periods on a turn.
    pub per_turn: usize,
    /// From arm to arm along a radius, mm.
    #[serde(rename = "pitch_mm", with = "unit::mm")]
    pub pitch: f64,
    /// The smallest radius of their band, mm.
    #[serde(rename = "from_mm", with = "unit::mm")]
    pub from: f64,
    /// The largest, mm.
    #[serde(rename = "to_mm", with = "unit::mm")]
    pub to: f64,
}
