//! The task: the part, the tool, the tolerances and the direction of the feed.

use serde::{Deserialize, Serialize};

use crate::Machine;

/// The part: a disc around the spindle axis, with or without a hole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Radius of the aperture, mm.
    pub aperture_radius: f64,
    /// Radius of the hole, mm; 0 without one.
    pub inner_radius: f64,
}

/// What happens where the nose does not fit: in hollows that are tighter than the nose, and on
/// slopes where the contact would leave the edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Misfit {
    /// The host refuses the task.
    #[default]
    Refuse,
    /// The tool stops where it first touches, and the part stays higher where the tool cannot go.
    CutWhatFits,
}

/// The tool: a round nose in the XZ plane with zero rake.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tool {
    /// Nose radius R, mm.
    pub nose_radius: f64,
    /// Included angle of the edge, rad. The contact can move by half of this angle to either side.
    pub included_angle: Option<f64>,
    /// Clearance angle below the edge, rad. It is the largest slope along the cut.
    pub clearance_angle: Option<f64>,
    /// What happens where the nose does not fit.
    pub misfit: Misfit,
}

impl Tool {
    /// The largest distance of the contact from the centre's X, mm: R·sin(half the included angle).
    pub fn reach(&self) -> f64 {
        match self.included_angle {
            Some(angle) if angle < std::f64::consts::PI => {
                self.nose_radius * libm::sin(0.5 * angle)
            }
            _ => self.nose_radius,
        }
    }
}

/// The tolerances of the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    /// Largest |played − true| tool centre along z, mm.
    pub interpolation: f64,
    /// Largest cusp along the profile's normal in the XZ plane, mm.
    pub residual: f64,
}

/// A range of the radial parameter ρ, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RadialRange {
    /// Smallest ρ.
    pub inner: f64,
    /// Largest ρ.
    pub outer: f64,
}

/// How far the path runs beyond the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overrun {
    /// As far as the contact needs to cover the whole part at every angle.
    Contact,
    /// Not at all: ρ runs over exactly the aperture.
    None,
    /// By this length, mm: at the rim, at the hole, and beyond the axis if there is no hole.
    Length(f64),
}

/// The direction of the feed. C increases with time in both directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// From the rim to the centre.
    Inward,
    /// From the centre to the rim.
    Outward,
}

/// All that a strategy may know of the task, apart from the locus.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The part.
    pub part: Part,
    /// The tool.
    pub tool: Tool,
    /// The tolerances.
    pub tolerance: Tolerance,
    /// The range of ρ that the path covers, overrun included.
    pub range: RadialRange,
    /// The direction of the feed.
    pub direction: Direction,
    /// The largest speed of the spindle, rad/s. A constant spindle turns at this speed.
    pub spindle_speed: f64,
    /// What the machine can do. A strategy may keep to these limits.
    pub machine: Machine,
}
