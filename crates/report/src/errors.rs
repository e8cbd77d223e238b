//! How far the path lies from the true one, and how high its cusps are.

use serde::{Deserialize, Serialize};

use crate::place::PathPlace;
use crate::unit;

/// The tolerances of a recipe; `None` for one that it does not ask for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerances {
    /// Largest interpolation error, mm.
    #[serde(rename = "interpolation_nm", with = "unit::nm")]
    pub interpolation: Option<f64>,
    /// Highest cusp, mm.
    #[serde(rename = "residual_nm", with = "unit::nm")]
    pub residual: Option<f64>,
    /// Peak to valley of the machined surface, mm. There is one, or both of the others.
    #[serde(default, rename = "form_nm", with = "unit::nm")]
    pub form: Option<f64>,
    /// Largest predicted error of the servos, mm.
    #[serde(default, rename = "servo_nm", with = "unit::nm")]
    pub servo: Option<f64>,
}

impl Tolerances {
    /// How much material may stay uncut, mm: the residual, or the form in its place.
    pub fn most_material(&self) -> Option<f64> {
        self.residual.or(self.form)
    }

    /// How deep the tool may go on its leads, mm: the interpolation tolerance, or the form in its
    /// place.
    pub fn deepest(&self) -> Option<f64> {
        self.interpolation.or(self.form)
    }
}

/// Played − true tool centre along z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InterpolationError {
    /// Largest amount, mm.
    #[serde(rename = "max_nm", with = "unit::nm")]
    pub max: f64,
    /// Root mean square over time, mm.
    #[serde(rename = "rms_nm", with = "unit::nm")]
    pub rms: f64,
    /// Where the largest is.
    pub at: PathPlace,
}

/// Control points − true tool centre along z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ControlPointError {
    /// Largest amount, mm.
    #[serde(rename = "max_nm", with = "unit::nm")]
    pub max: f64,
    /// Where it is.
    pub at: PathPlace,
}

/// Which cusps the residual leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LeftOut {
    /// None.
    #[serde(rename = "nothing")]
    Nothing,
    /// Those of the innermost turn: the passes of both sides of the axis lie farther apart.
    #[serde(rename = "the innermost turn")]
    InnermostTurn,
    /// All: no turn has a neighbour.
    #[serde(rename = "no turn has a neighbour")]
    Everything,
}

/// Cusps between neighbouring passes along the profile's normal, with the nose at the played X and
/// its true Z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// Highest cusp, mm; `None` where no pass has a neighbour, which holds no tolerance.
    #[serde(rename = "max_nm", with = "unit::nm")]
    pub max: Option<f64>,
    /// Where it is: the angle of its section and its radius.
    pub at: PathPlace,
    /// What the figure leaves out.
    pub left_out: LeftOut,
}

/// Cusps of the surface that the played path leaves, along the profile's normal: residual and
/// interpolation error together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlayedCusp {
    /// Height of the highest, mm.
    #[serde(rename = "max_nm", with = "unit::nm")]
    pub max: f64,
    /// Where it is: the angle of its section and its radius.
    pub at: PathPlace,
}
