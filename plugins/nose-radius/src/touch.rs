//! The nose, and where it touches the surface.

use turnpath_plugin::prelude::*;

use crate::polar::Ray;

/// The nose, as far as the search for its contact needs it.
#[derive(Debug, Clone, Copy)]
pub struct Nose {
    /// Radius of the nose, mm.
    pub radius: f64,
    /// The largest distance of the edge from the centre's X, mm.
    pub reach: f64,
}

/// sqrt(R² − d²): the height of the centre above the contact.
#[inline(always)]
pub fn rise<S: Scalar>(radius: f64, offset: S) -> S {
    ((-offset + radius) * (offset + radius)).sqrt()
}

/// The point where the nose touches.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// The ray at the nose's angle.
    pub ray: Ray,
    /// X of the nose centre, mm.
    pub rho: f64,
    /// The foot's radius less the centre's X, mm; NaN if there is no foot.
    pub offset: f64,
    /// Whether the end of the edge touches, so that the contact does not lie on the normal of the
    /// surface.
    pub at_edge_end: bool,
}

impl Touch {
    /// A touch whose foot is not known yet.
    pub fn unknown(ray: Ray, rho: f64) -> Self {
        Self {
            ray,
            rho,
            offset: f64::NAN,
            at_edge_end: false,
        }
    }

    /// Radius of the foot, mm.
    pub fn foot(&self) -> f64 {
        self.rho + self.offset
    }
}
