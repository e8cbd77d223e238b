//! What is allowed but seldom meant: a slip in a unit, a limit that is missing, a cut that takes all
//! night. A remark changes no verdict and no exit status.

use serde::{Deserialize, Serialize};

use crate::unit;

/// One remark, with its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Remark {
    /// The residual tolerance is that of no optical surface.
    RoughResidual {
        /// The tolerance, mm.
        #[serde(rename = "residual_nm", with = "unit::nm")]
        residual: f64,
    },
    /// The part is smaller than a grain of sand.
    SmallAperture {
        /// The aperture's diameter, mm.
        #[serde(rename = "aperture_mm", with = "unit::mm")]
        aperture: f64,
    },
    /// Z accelerates much, and the recipe has no limit for it.
    FastZ {
        /// The largest acceleration of Z, mm/s².
        #[serde(rename = "acceleration_mm_per_s2", with = "unit::s")]
        acceleration: f64,
    },
    /// The interpolation error exceeds its tolerance where refinement makes no shorter segments.
    ShortestSegments {
        /// Time of the segment with the largest error, s.
        #[serde(rename = "segment_time_s", with = "unit::s")]
        segment_time: f64,
        /// The shortest segment that refinement makes, s.
        #[serde(rename = "shortest_s", with = "unit::s")]
        shortest: f64,
    },
    /// The edge of the tool ends between the steepest contact and the place where neighbouring passes meet.
    ShortEdge {
        /// How far the edge goes on beyond the steepest contact, rad.
        #[serde(rename = "edge_deg", with = "unit::deg")]
        edge: f64,
        /// How far beyond their contacts neighbouring passes meet, about, rad.
        #[serde(rename = "meeting_deg", with = "unit::deg")]
        meeting: f64,
        /// The included angle with which the edge goes so far, rad.
        #[serde(rename = "included_angle_deg", with = "unit::deg")]
        included_angle: f64,
    },
    /// The cut takes longer than a working day.
    LongCut {
        /// Time of the cutting section, s.
        #[serde(rename = "cutting_time_s", with = "unit::s")]
        cutting_time: f64,
    },
    /// The decimals of a program's positions take much of the interpolation tolerance.
    CoarseDigits {
        /// The post; empty in a report of a version that looked at one program alone.
        #[serde(default)]
        post: String,
        /// Decimals of positions.
        position_decimals: u32,
        /// The most by which they move a position, mm.
        #[serde(rename = "rounding_nm", with = "unit::nm")]
        rounding: f64,
        /// The interpolation tolerance, mm.
        #[serde(rename = "tolerance_nm", with = "unit::nm")]
        tolerance: f64,
    },
    /// The controller's numbers have too few bits for a C of so many turns.
    CoarseNumbers {
        /// The post.
        post: String,
        /// C at the end of the path, rad.
        #[serde(rename = "c_deg", with = "unit::deg")]
        c: f64,
        /// The most by which C is moved there, rad.
        #[serde(rename = "c_rounding_deg", with = "unit::deg")]
        c_rounding: f64,
        /// The most by which this moves the tool along z against the surface, mm.
        #[serde(rename = "rounding_nm", with = "unit::nm")]
        rounding: f64,
        /// The interpolation tolerance, mm.
        #[serde(rename = "tolerance_nm", with = "unit::nm")]
        tolerance: f64,
    },
    /// A loop of the controller plays the path several times.
    SeveralDepths {
        /// The post.
        post: String,
        /// How often.
        depths: u32,
        /// By how much deeper each time, mm.
        #[serde(rename = "step_nm", with = "unit::nm")]
        step: f64,
        /// Time of all of them, with leads and Z's way down to each, and without rapid moves, s.
        #[serde(rename = "time_s", with = "unit::s")]
        time: f64,
    },
    /// The machine must keep more digits than controllers of this kind have on delivery.
    NeedsDigits {
        /// The post.
        post: String,
        /// Decimals of positions in the program.
        position_decimals: u32,
        /// Decimals of positions that the controller has on delivery.
        delivered_decimals: u32,
    },
    /// The decimals of a program's velocities take much of the interpolation tolerance.
    CoarseVelocityDigits {
        /// The post; empty in a report of a version that looked at one program alone.
        #[serde(default)]
        post: String,
        /// Decimals of velocities.
        velocity_decimals: u32,
        /// The most by which they move the middle of a segment of mean time, mm.
        #[serde(rename = "rounding_nm", with = "unit::nm")]
        rounding: f64,
        /// The mean time of a segment, s.
        #[serde(rename = "segment_time_s", with = "unit::s")]
        segment_time: f64,
        /// The interpolation tolerance, mm.
        #[serde(rename = "tolerance_nm", with = "unit::nm")]
        tolerance: f64,
    },
    /// Points of a map have no height, and were filled.
    FilledPoints {
        /// Points without a height.
        filled: u64,
        /// All points.
        points: u64,
    },
    /// The path leaves the data that the surface was made from.
    BeyondData {
        /// Whether the place lies on the part, and not on its overrun alone.
        on_part: bool,
        /// How far the place lies beyond the data, mm.
        #[serde(rename = "distance_mm", with = "unit::mm")]
        distance: f64,
        /// The radius of the place, mm.
        #[serde(rename = "radius_mm", with = "unit::mm")]
        radius: f64,
        /// The angle of the place, rad.
        #[serde(rename = "c_deg", with = "unit::deg")]
        c: f64,
        /// How the surface goes on there, in a few words.
        continuation: String,
    },
    /// A spline stands for a function that is no formula.
    FittedSurface {
        /// Points of the spline.
        points: u64,
        /// The largest distance along z that was found between both, mm.
        #[serde(rename = "error_nm", with = "unit::nm")]
        error: f64,
        /// The interpolation tolerance, mm.
        #[serde(rename = "tolerance_nm", with = "unit::nm")]
        tolerance: f64,
    },
    /// Strategies call functions whose last bits depend on the machine.
    NotByteExact {
        /// Slot and name of each.
        strategies: Vec<String>,
        /// The plugin that they come from.
        plugin: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remark_in_a_file_has_its_kind_and_its_numbers_with_units() {
        let remark = Remark::RoughResidual { residual: 1e-2 };
        let text = serde_json::to_string(&remark).unwrap();
        assert_eq!(text, r#"{"kind":"rough_residual","residual_nm":10000.0}"#);
        assert_eq!(serde_json::from_str::<Remark>(&text).unwrap(), remark);
    }
}
