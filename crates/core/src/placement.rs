//! How a surface enters a sum.

/// How a surface enters a sum: scale · f(R(−clocking)(r − decentre)) + piston.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Factor on the height. A negative one takes the surface away from the sum.
    pub scale: f64,
    /// Where the surface's own origin lies, along x, mm.
    pub decentre_x: f64,
    /// Where the surface's own origin lies, along y, mm.
    pub decentre_y: f64,
    /// Angle by which the surface is turned about its own origin, from x to y, rad.
    pub clocking: f64,
    /// Height that is added after the scale, mm.
    pub piston: f64,
}

impl Placement {
    /// The surface as it is.
    pub const PLAIN: Self = Self {
        scale: 1.0,
        decentre_x: 0.0,
        decentre_y: 0.0,
        clocking: 0.0,
        piston: 0.0,
    };

    /// Whether the surface enters the sum as it is.
    pub fn is_plain(&self) -> bool {
        *self == Self::PLAIN
    }
}

impl Default for Placement {
    fn default() -> Self {
        Self::PLAIN
    }
}
