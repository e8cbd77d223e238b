//! The machined surface against the tolerance of its form.

use serde::{Deserialize, Serialize};
use turnpath_core::Tolerance;

use crate::unit;

/// Peak to valley of the machined surface against its tolerance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FormReport {
    /// The tolerance, mm.
    #[serde(rename = "tolerance_nm", with = "unit::nm")]
    pub tolerance: f64,
    /// Peak to valley of machined − wanted along z, mm, everything included: cusps, interpolation,
    /// leads. It counts from what the nose can reach. If the path does not cover the part, it counts
    /// where the path cuts. `None` where nothing of the part is cut, which holds no tolerance.
    #[serde(rename = "pv_nm", with = "unit::nm")]
    pub pv: Option<f64>,
    /// What the path was made for; `None` for a file, which does not say.
    #[serde(flatten)]
    pub split: Option<FormSplit>,
}

/// How a run divided a tolerance of form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FormSplit {
    /// The residual that the path was made for, mm.
    #[serde(rename = "residual_nm", with = "unit::nm")]
    pub residual: f64,
    /// The interpolation tolerance that the path was made for, mm.
    #[serde(rename = "interpolation_nm", with = "unit::nm")]
    pub interpolation: f64,
    /// How often the path was made.
    pub rounds: u32,
    /// Why a path for a better division could not be made; `None` where nothing stood in the way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search_ended_because: Option<String>,
    /// Whether the recipe's own feed and steps decide the form: paths for tolerances that lay far
    /// apart left the same. Left out where it is false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub decided_by_recipe: bool,
}

impl FormSplit {
    /// The tolerances that the path was made for.
    pub fn tolerance(&self) -> Tolerance {
        Tolerance {
            interpolation: self.interpolation,
            residual: self.residual,
        }
    }
}
