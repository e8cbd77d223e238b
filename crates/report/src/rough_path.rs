//! The paths before the finishing one.

use serde::{Deserialize, Serialize};

use crate::program::ProgramReport;
use crate::unit;
use crate::verdict::Verdict;

/// A path before the finishing one, measured like it against the wanted surface lifted by the
/// allowance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoughPathReport {
    /// Its name in the recipe.
    pub name: String,
    /// What it should leave on the wanted surface along z, mm.
    #[serde(rename = "allowance_um", with = "unit::um")]
    pub allowance: f64,
    /// What it leaves, mm; `None` where nothing of the part is cut.
    pub left: Option<Left>,
    /// Control points of the cutting section.
    pub control_points: u64,
    /// Control points of all sections.
    pub rows: u64,
    /// Revolutions of the cutting section.
    #[serde(with = "unit::one")]
    pub revolutions: f64,
    /// Time of the cutting section, s.
    #[serde(rename = "cutting_time_s", with = "unit::s")]
    pub cutting_time: f64,
    /// Largest interpolation error, mm.
    #[serde(rename = "interpolation_error_nm", with = "unit::nm")]
    pub interpolation_error: f64,
    /// Highest cusp, mm; `None` where no two passes meet on the part.
    #[serde(rename = "residual_nm", with = "unit::nm")]
    pub residual: Option<f64>,
    /// The motion programs.
    pub programs: Vec<ProgramReport>,
    /// Which of its tolerances and limits hold.
    pub within: Verdict,
}

/// The material that a path leaves on the wanted surface along z, as machined.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// Where least is left, mm.
    #[serde(rename = "least_um", with = "unit::um")]
    pub least: f64,
    /// The mean, weighted by area, mm.
    #[serde(rename = "mean_um", with = "unit::um")]
    pub mean: f64,
    /// Where most is left, mm.
    #[serde(rename = "most_um", with = "unit::um")]
    pub most: f64,
}
