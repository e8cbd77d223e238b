//! What the nose leaves standing where it does not fit.

use serde::{Deserialize, Serialize};

use crate::place::PathPlace;
use crate::unit;

/// What stays on a part that is cut as far as the nose fits.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Unreached {
    /// Largest height above the surface along z, mm.
    #[serde(rename = "height_um", with = "unit::um")]
    pub height: f64,
    /// Volume, mm³.
    #[serde(rename = "volume_mm3", with = "unit::mm")]
    pub volume: f64,
    /// Where the largest height is.
    pub at: PathPlace,
    /// Part of the area that stays higher than the residual tolerance, along z.
    #[serde(with = "unit::one")]
    pub area_fraction: f64,
}
