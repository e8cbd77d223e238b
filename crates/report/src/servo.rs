//! What the axes' servos make of the path, by a model of them.

use serde::{Deserialize, Serialize};

use crate::place::PathPlace;
use crate::unit;

/// Following error of the axes, and the error of the surface that it predicts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ServoReport {
    /// Where the axes are − where they were commanded to be, over the cut.
    pub following_error: FollowingErrors,
    /// Where the axes bring the tool − the true tool centre, along z.
    pub predicted_error: PredictedError,
}

/// Following errors of the axes. Files hold X and Z in µm, C in seconds of arc.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FollowingErrors {
    /// Of X, mm.
    pub x: LinearLag,
    /// Of Z, mm.
    pub z: LinearLag,
    /// Of C, rad.
    pub c: RotaryLag,
}

/// How far a slide lags, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LinearLag {
    /// Largest amount.
    #[serde(rename = "max_um", with = "unit::um")]
    pub max: f64,
    /// Root mean square over time.
    #[serde(rename = "rms_um", with = "unit::um")]
    pub rms: f64,
}

/// How far the spindle lags, rad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RotaryLag {
    /// Largest amount.
    #[serde(rename = "max_arcsec", with = "unit::arcsec")]
    pub max: f64,
    /// Root mean square over time.
    #[serde(rename = "rms_arcsec", with = "unit::arcsec")]
    pub rms: f64,
}

/// Error of the surface that the lags predict, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PredictedError {
    /// Largest amount.
    #[serde(rename = "max_nm", with = "unit::nm")]
    pub max: f64,
    /// Root mean square over time.
    #[serde(rename = "rms_nm", with = "unit::nm")]
    pub rms: f64,
    /// Where the largest is.
    pub at: PathPlace,
}
