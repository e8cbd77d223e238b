//! A map against the surface of a recipe.

use serde::{Deserialize, Serialize};

use crate::unit;

/// Map minus surface along z at the points of a map, each point with the same weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapComparison {
    /// The form of the JSON text, [`FORMAT`](crate::FORMAT).
    pub format: u32,
    /// The job's name.
    pub name: String,
    /// The file of the map.
    pub map: String,
    /// Points that were compared: those on the part where map and surface have a height.
    pub points: u64,
    /// Points beyond the part or in its hole.
    pub beyond_part: u64,
    /// Points on the part where the map has no height.
    pub without_height: u64,
    /// Points on the part where the surface has no height.
    pub without_surface: u64,
    /// Peak to valley, mm. A piston does not change it.
    #[serde(rename = "pv_nm", with = "unit::nm")]
    pub pv: f64,
    /// Root mean square of the difference as it is, piston included, mm.
    #[serde(rename = "rms_nm", with = "unit::nm")]
    pub rms: f64,
    /// The mean, which is the piston, mm.
    #[serde(rename = "mean_nm", with = "unit::nm")]
    pub mean: f64,
    /// Root mean square about the mean, piston removed, mm.
    #[serde(rename = "rms_without_piston_nm", with = "unit::nm")]
    pub rms_without_piston: f64,
    /// Where the amount is largest, piston included.
    pub worst: MapPlace,
    /// Where the map is highest above the surface.
    pub highest: MapPlace,
    /// Where it is lowest.
    pub lowest: MapPlace,
}

/// A point of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MapPlace {
    /// Map minus surface along z, mm.
    #[serde(rename = "difference_nm", with = "unit::nm")]
    pub difference: f64,
    /// mm.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: f64,
    /// mm.
    #[serde(rename = "y_mm", with = "unit::mm")]
    pub y: f64,
}
