//! The sketch of a path: what pictures of it need. No figure and no verdict depends on it.

use serde::{Deserialize, Serialize};

use crate::samples::Samples;
use crate::unit;

/// The error of a path, as pictures show it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorSketch {
    /// Machined − wanted; `None` where nothing of the part is cut.
    pub map: Option<ErrorMap>,
    /// The mean of each ring; `None` where nothing of the part is cut.
    pub radial_mean: Option<RadialMean>,
    /// The amplitude of each harmonic of the error as played, mm, averaged over 64 turns, at its
    /// largest: entry k has k periods a turn. Empty on a path of less than a turn.
    #[serde(rename = "harmonics_nm", with = "unit::nm")]
    pub harmonics: Samples,
}

/// Machined − wanted along z on the square around the part. A cell has the mean along the radius over
/// a 192nd of the way from the axis, or the hole, to the rim: so cusps do not show one by one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorMap {
    /// Cells along each side.
    pub cells: usize,
    /// Half of the side, mm.
    #[serde(rename = "half_mm", with = "unit::mm")]
    pub half: f64,
    /// Row after row, from the largest y down, and in a row from the smallest x up, mm; not a number
    /// off the part and where no pass has cut.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub errors: Samples,
}

/// The mean of machined − wanted on rings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RadialMean {
    /// The middle of each ring, mm.
    #[serde(rename = "radius_mm", with = "unit::mm")]
    pub radius: Samples,
    /// The mean, mm.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub errors: Samples,
}

/// A whole path, as pictures show it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathSketch {
    /// Its error.
    #[serde(flatten)]
    pub error: ErrorSketch,
    /// Lines through the axis.
    pub profiles: Vec<ErrorProfile>,
    /// Places of the tool.
    pub spiral: SpiralSketch,
    /// The motion along the path.
    pub turns: TurnSketch,
    /// What stays against the angle.
    pub edges: EdgeSketch,
}

/// Machined − wanted along a line through the axis, averaged like a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorProfile {
    /// The angle of the line, rad.
    #[serde(rename = "angle_deg", with = "unit::deg")]
    pub angle: f64,
    /// Signed radius, mm.
    #[serde(rename = "s_mm", with = "unit::mm")]
    pub s: Samples,
    /// The error, mm.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub errors: Samples,
}

/// Places of the tool along the path, 12,000 at the most.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpiralSketch {
    /// X of the path, turned by C onto the part, mm.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: Samples,
    /// mm.
    #[serde(rename = "y_mm", with = "unit::mm")]
    pub y: Samples,
    /// The largest |played − true| from there to the next place, mm.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub errors: Samples,
}

/// The motion along the path: an entry for each turn, or for some neighbouring ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TurnSketch {
    /// The mean X, mm.
    #[serde(rename = "radius_mm", with = "unit::mm")]
    pub radius: Samples,
    /// How far X goes in a turn, mm.
    #[serde(rename = "feed_um_per_rev", with = "unit::um")]
    pub feed: Samples,
    /// Control points in a turn.
    #[serde(with = "unit::one")]
    pub points_per_turn: Samples,
    /// The mean speed of the spindle, rad/s.
    #[serde(rename = "spindle_rpm", with = "unit::rpm")]
    pub spindle: Samples,
    /// The largest |played − true|, mm.
    #[serde(rename = "error_nm", with = "unit::nm")]
    pub errors: Samples,
    /// The largest amounts of the feed axis.
    pub x: AxisSketch,
    /// The largest amounts of the depth axis.
    pub z: AxisSketch,
}

/// The largest amounts of one slide in each turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisSketch {
    /// mm/s.
    #[serde(rename = "velocity_mm_per_s", with = "unit::mm")]
    pub velocity: Samples,
    /// mm/s².
    #[serde(rename = "acceleration_mm_per_s2", with = "unit::mm")]
    pub acceleration: Samples,
    /// mm/s³, within segments.
    #[serde(rename = "jerk_mm_per_s3", with = "unit::mm")]
    pub jerk: Samples,
}

/// What stays of the material against the angle, on as many sections as an array has entries, from
/// C = 0 on. What has no figure, or is infinite since no pass reaches, is not a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EdgeSketch {
    /// The highest cusp, mm.
    #[serde(rename = "residual_nm", with = "unit::nm")]
    pub residual: Samples,
    /// What is uncut at the rim, mm.
    #[serde(rename = "rim_nm", with = "unit::nm")]
    pub rim: Samples,
    /// What is uncut at the hole, mm; empty without one.
    #[serde(rename = "hole_nm", with = "unit::nm")]
    pub hole: Samples,
}
