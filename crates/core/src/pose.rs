//! Where the part lies on a surface, and how it is turned.

/// A rigid motion: the point of the surface above (x, y) comes to the origin, and the surface is
/// turned about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The part's middle on the surface, along x, mm.
    pub x: f64,
    /// The part's middle on the surface, along y, mm.
    pub y: f64,
    /// How the surface is turned.
    pub attitude: Attitude,
}

/// How a pose turns the surface about the part's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Attitude {
    /// By the shortest rotation that lays the normal at the middle onto the spindle axis.
    Level,
    /// By given angles, right-handed about the machine's axes: first about x, then about y.
    Tilted {
        /// About x, rad. A positive angle lifts the side of positive y.
        tilt_x: f64,
        /// About y, rad. A positive angle lowers the side of positive x.
        tilt_y: f64,
    },
}

impl Attitude {
    /// The surface as it lies.
    pub const UNTURNED: Self = Self::Tilted {
        tilt_x: 0.0,
        tilt_y: 0.0,
    };
}
