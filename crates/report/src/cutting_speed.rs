//! How fast the part passes under the nose.

use serde::{Deserialize, Serialize};

use crate::unit;

/// The cutting speed over the cut: the speed of the spindle times |X|.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CuttingSpeed {
    /// The smallest at a control point, mm/s. It is next to 0 where a path ends at the axis.
    #[serde(rename = "least_mm_per_s", with = "unit::mm")]
    pub least: f64,
    /// The mean over time, mm/s.
    #[serde(rename = "mean_mm_per_s", with = "unit::mm")]
    pub mean: f64,
    /// The largest at a control point, mm/s.
    #[serde(rename = "most_mm_per_s", with = "unit::mm")]
    pub most: f64,
    /// The lowest speed of the spindle at a control point, rad/s.
    #[serde(rename = "spindle_least_rpm", with = "unit::rpm")]
    pub spindle_least: f64,
    /// The highest speed of the spindle at a control point, rad/s.
    #[serde(rename = "spindle_most_rpm", with = "unit::rpm")]
    pub spindle_most: f64,
}
