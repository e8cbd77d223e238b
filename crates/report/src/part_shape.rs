//! The shape of the part itself, whatever tool cuts it.

use serde::{Deserialize, Serialize};

use crate::format::{FORMAT, rounded_for_files};
use crate::unit;

/// The extremes of the part's surface, all of them on the part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartShape {
    /// The lowest place.
    pub lowest: PartHeight,
    /// The highest place.
    pub highest: PartHeight,
    /// The place with the largest slope.
    pub steepest: PartSlope,
    /// The place with the largest principal curvature, that of the sharpest hollow.
    pub most_hollow: PartCurvature,
    /// The place with the smallest principal curvature, that of the sharpest dome.
    pub most_domed: PartCurvature,
}

/// A height on the part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PartHeight {
    /// z, mm.
    #[serde(rename = "height_mm", with = "unit::mm")]
    pub height: f64,
    /// Where it is.
    pub at: PartPlace,
}

/// A slope on the part, in whatever direction it is the largest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PartSlope {
    /// Angle to the horizontal, rad.
    #[serde(rename = "angle_deg", with = "unit::deg")]
    pub angle: f64,
    /// Where it is.
    pub at: PartPlace,
}

/// A curvature on the part, in the direction in which it is the largest or the smallest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PartCurvature {
    /// 1/mm; positive in a hollow, negative on a dome.
    #[serde(rename = "curvature_per_mm", with = "unit::mm")]
    pub curvature: f64,
    /// Whether the surface is not smooth there, as on the tip of a cone: the curvature has no bound,
    /// and the figure is that of the closest place that was looked at.
    #[serde(default)]
    pub tip: bool,
    /// Where it is.
    pub at: PartPlace,
}

/// A place on the part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PartPlace {
    /// mm.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: f64,
    /// mm.
    #[serde(rename = "y_mm", with = "unit::mm")]
    pub y: f64,
}

/// A check that ended early: what is known of the part, and why the recipe is refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RefusedCheck {
    /// The form of the JSON text, [`FORMAT`].
    pub format: u32,
    /// The job's name.
    pub name: String,
    /// The part's own shape.
    pub part: PartShape,
    /// Why the recipe is refused.
    pub refused: String,
}

impl RefusedCheck {
    /// The report with all numbers rounded to the digits of files.
    #[must_use]
    pub fn rounded(mut self) -> Self {
        self.format = FORMAT;
        rounded_for_files(self)
    }
}
