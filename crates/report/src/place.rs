//! Places: of the tool on its path, and of a point on the part.

use serde::{Deserialize, Serialize};

use crate::unit;

/// A place of the tool on its path.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PathPlace {
    /// C, unwrapped, rad.
    #[serde(rename = "c_deg", with = "unit::deg")]
    pub c: f64,
    /// X of the nose centre, mm; of a section the radius.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: f64,
}

/// A point of the part and the surface error there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SurfacePoint {
    /// Machined − wanted along z, mm.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub error: f64,
    /// mm.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: f64,
    /// mm.
    #[serde(rename = "y_mm", with = "unit::mm")]
    pub y: f64,
}
