//! Surfaces with a formula, for tests of what is made of them.
#![allow(dead_code, reason = "each test uses what it needs")]

use turnpath_core::{Scalar, Surface};

/// A conicoid of revolution: curvature at the vertex and conic number.
pub struct Conicoid {
    pub curvature: f64,
    pub conic: f64,
}

impl Surface for Conicoid {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = x.squared() + y.squared();
        let bend = (1.0 + self.conic) * self.curvature * self.curvature;
        square * self.curvature / ((-(square * bend) + 1.0).sqrt() + 1.0)
    }
}

/// The paraboloid of radius `vertex` about its own axis, in the frame of the normal at the distance
/// `off_axis` from that axis: the quadratic equation for z, solved.
pub struct Segment {
    pub vertex: f64,
    pub off_axis: f64,
}

impl Surface for Segment {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let slant = Scalar::hypot(self.vertex, self.off_axis).copysign(self.vertex);
        let (sin, cos) = (self.off_axis / slant, self.vertex / slant);
        let b = x * (sin * cos) + slant;
        let q = x.squared() * (cos * cos) + y.squared();
        let root = (b.squared() - q * (sin * sin)).sqrt();
        q / (b + root * self.vertex.signum())
    }
}

/// Waves along both axes, without any symmetry.
pub struct Waves {
    pub height: f64,
    /// rad/mm.
    pub wave: f64,
}

impl Surface for Waves {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        ((x * self.wave + 0.3).sin() + (y * (1.3 * self.wave) - x * 0.2).cos()) * self.height
    }
}

/// The plane z = ax + by + c.
pub struct Plane(pub f64, pub f64, pub f64);

impl Surface for Plane {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * self.0 + y * self.1 + self.2
    }
}
