//! The leads of a path: from rest to the cut, and from the cut to rest.

use serde::{Deserialize, Serialize};

use crate::axes::Axes;
use crate::machine::LimitFigure;
use crate::place::PathPlace;
use crate::unit;

/// The leads of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeadReport {
    /// How the run made them; a file does not say.
    #[serde(flatten)]
    pub layout: Option<LeadLayout>,
    /// Smallest height of Z above the first touch, mm. At the joins it is 0, and between control
    /// points near them a little less.
    #[serde(rename = "smallest_clearance_nm", with = "unit::nm")]
    pub smallest_clearance: f64,
    /// Where that is.
    pub at: PathPlace,
    /// How far X as played goes beyond the axis, mm; 0 where it does not.
    #[serde(rename = "axis_crossing_um", with = "unit::um")]
    pub axis_crossing: f64,
    /// Largest steps of the acceleration at the control points, those of the joins included.
    pub acceleration_step: AccelerationStep,
    /// Motion of the axes.
    pub axes: Axes,
    /// Each limit of the machine with what was measured on the leads.
    pub limits: Vec<LimitFigure>,
}

/// How a run made its leads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LeadLayout {
    /// Time of the lead-in, s.
    #[serde(rename = "in_s", with = "unit::s")]
    pub in_time: f64,
    /// Time of the lead-out, s.
    #[serde(rename = "out_s", with = "unit::s")]
    pub out_time: f64,
    /// Revolutions of the lead-in.
    #[serde(with = "unit::one")]
    pub turns_in: f64,
    /// Revolutions of the lead-out.
    #[serde(with = "unit::one")]
    pub turns_out: f64,
    /// Control points of both.
    pub control_points: u64,
    /// How far the path rests above the highest place of the part, mm.
    #[serde(rename = "rest_clearance_mm", with = "unit::mm")]
    pub rest_clearance: f64,
}

/// Steps of the acceleration, mm/s² or rad/s².
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AccelerationStep {
    /// Of X.
    #[serde(rename = "x_mm_per_s2", with = "unit::mm")]
    pub x: f64,
    /// Of Z.
    #[serde(rename = "z_mm_per_s2", with = "unit::mm")]
    pub z: f64,
    /// Of C.
    #[serde(rename = "c_deg_per_s2", with = "unit::deg")]
    pub c: f64,
}
