//! What the part asks of a tool, where, and how much the tool has to spare.

use serde::{Deserialize, Serialize};

use crate::unit;

/// What the part and its overrun ask of a tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToolFit {
    /// The largest nose radius that fits, mm; `None` where any fits.
    #[serde(rename = "largest_nose_radius_mm", with = "unit::mm")]
    pub largest_nose_radius: Option<f64>,
    /// The smallest included angle that fits, rad.
    #[serde(rename = "least_included_angle_deg", with = "unit::deg")]
    pub least_included_angle: f64,
    /// The smallest clearance angle that fits, rad.
    #[serde(rename = "least_clearance_angle_deg", with = "unit::deg")]
    pub least_clearance_angle: f64,
    /// How much the tool has to spare.
    pub margins: Margins,
    /// The steepest sectional curves.
    pub sections: Sections,
}

/// How much the tool has to spare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Margins {
    /// Of the nose radius.
    pub nose_radius: NoseMargin,
    /// Of the included angle.
    pub included_angle: AngleMargin,
    /// Of the clearance angle.
    pub clearance_angle: AngleMargin,
}

/// How much smaller the nose radius is than the largest that fits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NoseMargin {
    /// The tool's, mm.
    #[serde(rename = "given_mm", with = "unit::mm")]
    pub given: f64,
    /// The largest that fits, mm; `None` where any fits.
    #[serde(rename = "most_mm", with = "unit::mm")]
    pub most: Option<f64>,
    /// The difference, mm.
    #[serde(rename = "margin_mm", with = "unit::mm")]
    pub margin: Option<f64>,
    /// What limits it; `None` where nothing does, and where the surface ends within the reach of a
    /// larger nose.
    pub at: Option<ContactPlace>,
}

/// How much larger an angle of the tool is than the smallest that fits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AngleMargin {
    /// The tool's, rad; `None` where the recipe gives none.
    #[serde(rename = "given_deg", with = "unit::deg")]
    pub given: Option<f64>,
    /// The smallest that fits, rad.
    #[serde(rename = "least_deg", with = "unit::deg")]
    pub least: f64,
    /// The difference, rad.
    #[serde(rename = "margin_deg", with = "unit::deg")]
    pub margin: Option<f64>,
    /// What limits it.
    pub at: Option<ContactPlace>,
}

/// The steepest sectional curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sections {
    /// The sharpest hollow of a radial section.
    pub hollow: Hollow,
    /// The steepest rise outward.
    pub rises_outward: Slope,
    /// The steepest fall outward.
    pub falls_outward: Slope,
    /// The steepest rise along the cut, the way C turns.
    pub rises_along_cut: Slope,
    /// The steepest fall along the cut.
    pub falls_along_cut: Slope,
}

/// The sharpest hollow of a radial section.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hollow {
    /// Its curvature, 1/mm; below 0 where there is no hollow.
    #[serde(rename = "curvature_per_mm", with = "unit::mm")]
    pub curvature: f64,
    /// Where it is.
    pub at: ContactPlace,
}

/// The steepest place of a section.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Slope {
    /// Angle to the horizontal, rad; below 0 where the section slopes nowhere that way.
    #[serde(rename = "angle_deg", with = "unit::deg")]
    pub angle: f64,
    /// Where it is.
    pub at: ContactPlace,
}

/// A place of contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactPlace {
    /// mm.
    #[serde(rename = "x_mm", with = "unit::mm")]
    pub x: f64,
    /// mm.
    #[serde(rename = "y_mm", with = "unit::mm")]
    pub y: f64,
    /// Radius, mm.
    #[serde(rename = "rho_mm", with = "unit::mm")]
    pub rho: f64,
    /// Angle within a turn, rad.
    #[serde(rename = "c_deg", with = "unit::deg")]
    pub c: f64,
    /// Whether it is on the part.
    pub on: Region,
}

/// Whether a place is on the part, or only passed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Region {
    /// On the part.
    Part,
    /// Beyond its edges.
    Overrun,
}
