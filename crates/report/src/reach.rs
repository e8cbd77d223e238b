//! Whether a path covers the part, from its hole or its axis to its rim.

use serde::{Deserialize, Serialize};

use crate::unit;

/// By how much a path may end short of the part's edges, mm. A file's digits cost 1e-7 mm and the
/// search for the contact less. A turn that is missing costs a feed, some micrometres at least.
const SHORTFALL: f64 = 1e-3;

/// What a compensator's ρ stands for, and so what reaches an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Radial {
    /// The radius of the contact.
    Contact,
    /// X of the nose centre.
    Centre,
}

impl From<turnpath_core::Radial> for Radial {
    fn from(radial: turnpath_core::Radial) -> Self {
        match radial {
            turnpath_core::Radial::Contact => Self::Contact,
            turnpath_core::Radial::Centre => Self::Centre,
        }
    }
}

/// Radii from the hole or the axis to the rim, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Radii {
    /// The smaller one.
    #[serde(rename = "inner_mm", with = "unit::mm")]
    pub inner: f64,
    /// The larger one.
    #[serde(rename = "outer_mm", with = "unit::mm")]
    pub outer: f64,
}

/// From where to where a path runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// The radii that the path runs over.
    #[serde(flatten)]
    pub path: Radii,
    /// What the radii are of.
    pub of: Radial,
    /// The radii of the part.
    pub part: Radii,
}

impl Reach {
    /// Whether the path reaches both edges of the part.
    pub fn covers_part(&self) -> bool {
        self.path.outer >= self.part.outer - SHORTFALL
            && self.path.inner <= self.part.inner + SHORTFALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covers(inner: f64, outer: f64) -> bool {
        let reach = Reach {
            path: Radii { inner, outer },
            of: Radial::Centre,
            part: Radii {
                inner: 2.0,
                outer: 10.0,
            },
        };
        reach.covers_part()
    }

    #[test]
    fn a_path_covers_a_part_whose_both_edges_it_reaches() {
        assert!(covers(2.0, 10.0));
        assert!(covers(0.0, 11.0));
        assert!(covers(2.000_000_1, 9.999_999_9));
        assert!(!covers(2.0, 9.99));
        assert!(!covers(2.01, 10.0));
        assert!(!covers(f64::NAN, 10.0));
    }
}
