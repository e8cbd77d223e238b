//! Where a fault shows.

use std::fmt;

use turnpath_core::DEG;

/// A place in polar coordinates of the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnPart {
    /// C, rad.
    pub theta: f64,
    /// The distance from the axis, mm; negative beyond it.
    pub rho: f64,
}

/// A place along the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlongPath {
    /// C from the path's start on, rad.
    pub c: f64,
    /// X, mm.
    pub x: f64,
}

impl fmt::Display for OnPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "C = {:.3} deg, radius {:.6} mm",
            self.theta / DEG,
            self.rho
        )
    }
}

impl fmt::Display for AlongPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "C = {:.3} deg, X = {:.6} mm", self.c / DEG, self.x)
    }
}
