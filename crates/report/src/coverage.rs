//! What no pass has cut at the part's edges and around the axis, and how far X crosses the axis.

use serde::{Deserialize, Serialize};

use crate::unit;

/// How far the path runs beyond the part, as the recipe says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Overrun {
    /// Until the contact has covered the whole part.
    #[serde(rename = "contact")]
    Contact,
    /// Not at all.
    #[serde(rename = "none")]
    None,
    /// By a length, mm.
    #[serde(rename = "length_mm")]
    Length(#[serde(with = "unit::mm")] f64),
}

impl Overrun {
    /// Whether the path covers the axis on purpose. The cusps there are then residual.
    pub fn covers_centre(self) -> bool {
        self != Self::None
    }

    /// Whether the path covers the whole part. What stays uncut is then held to the residual
    /// tolerance.
    pub fn covers_part(self) -> bool {
        self == Self::Contact
    }
}

impl From<turnpath_core::Overrun> for Overrun {
    fn from(overrun: turnpath_core::Overrun) -> Self {
        match overrun {
            turnpath_core::Overrun::Contact => Self::Contact,
            turnpath_core::Overrun::None => Self::None,
            turnpath_core::Overrun::Length(length) => Self::Length(length),
        }
    }
}

/// The largest height that stays uncut at an edge or around the axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Uncut {
    /// Height, mm; `None` where no pass reaches.
    #[serde(rename = "height_nm", with = "unit::nm")]
    pub height: Option<f64>,
    /// Angle of its section, rad.
    #[serde(rename = "c_deg", with = "unit::deg")]
    pub c: f64,
}

/// What stays uncut; `None` where the part has no such edge.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Coverage {
    /// At the rim of the aperture.
    pub rim: Option<Uncut>,
    /// At the hole.
    pub hole: Option<Uncut>,
    /// Around the axis of a part without a hole.
    pub centre: Option<Uncut>,
}

impl Coverage {
    /// The edges that the part has, each with its name.
    pub fn edges(&self) -> impl Iterator<Item = (&'static str, Uncut)> {
        let all = [
            ("rim", self.rim),
            ("hole", self.hole),
            ("centre", self.centre),
        ];
        all.into_iter()
            .filter_map(|(name, uncut)| uncut.map(|uncut| (name, uncut)))
    }

    /// The largest height anywhere, mm; infinite where no pass reaches.
    pub fn largest(&self) -> f64 {
        let heights = self.edges().map(|(_, uncut)| uncut.height);
        heights
            .map(|height| height.unwrap_or(f64::INFINITY))
            .fold(0.0, f64::max)
    }
}

/// How far the tool goes beyond the axis; 0 where it does not.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AxisCrossing {
    /// X of the nose centre as played, mm.
    #[serde(rename = "x_um", with = "unit::um")]
    pub x: f64,
    /// The contact, mm.
    #[serde(rename = "contact_um", with = "unit::um")]
    pub contact: f64,
}

/// X below 0 from which a crossing is reported, mm. Less is the rounding of a path that ends on the
/// axis.
pub const SMALLEST_CROSSING: f64 = 1e-6;
