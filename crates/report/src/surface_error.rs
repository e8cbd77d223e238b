//! The machined surface against the wanted one.

use serde::{Deserialize, Serialize};

use crate::place::SurfacePoint;
use crate::unit;

/// Machined − wanted along z, weighted by area.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SurfaceError {
    /// Peak to valley, mm.
    #[serde(rename = "pv_nm", with = "unit::nm")]
    pub pv: f64,
    /// Root mean square about zero, mm.
    #[serde(rename = "rms_nm", with = "unit::nm")]
    pub rms: f64,
    /// Root mean square about the mean, mm.
    #[serde(rename = "sq_nm", with = "unit::nm")]
    pub sq: f64,
    /// Mean amount about the mean, mm.
    #[serde(rename = "sa_nm", with = "unit::nm")]
    pub sa: f64,
    /// Mean, mm.
    #[serde(rename = "mean_nm", with = "unit::nm")]
    pub mean: f64,
    /// Where most material stays.
    pub highest: SurfacePoint,
    /// Where most is lacking, or least stays.
    pub lowest: SurfacePoint,
    /// Root mean square of the radial slope's error, rad.
    #[serde(rename = "slope_rms_urad", with = "unit::urad")]
    pub slope_rms: f64,
    /// Part of the area that no nose reaches. No other figure includes it.
    #[serde(rename = "uncut_percent", with = "unit::percent")]
    pub uncut: f64,
}

/// What the real nose leaves where the path takes its radius as 0: machined − wanted along z, with
/// the nose's lowest point at the played points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RealNose {
    /// Peak to valley, mm.
    #[serde(rename = "pv_nm", with = "unit::nm")]
    pub pv: f64,
    /// Where most material stays.
    pub highest: SurfacePoint,
    /// Where the nose goes deepest. A negative error is a gouge.
    pub lowest: SurfacePoint,
}
