//! The frame of a part on its surface.

use turnpath_core::{Attitude, Pose, Scalar};

/// A vector in the surface's coordinates.
type Vector = [f64; 3];

/// The part's axes and its middle, in the surface's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    middle: Vector,
    x_axis: Vector,
    y_axis: Vector,
    pub(super) z_axis: Vector,
}

impl Frame {
    /// The frame of a pose. `height` and `slopes` are those of the surface at the pose's middle.
    pub(super) fn new(pose: Pose, height: f64, slopes: (f64, f64)) -> Self {
        let [x_axis, y_axis, z_axis] = match pose.attitude {
            Attitude::Level => level(slopes),
            Attitude::Tilted { tilt_x, tilt_y } => tilted(tilt_x, tilt_y),
        };
        Self {
            middle: [pose.x, pose.y, height],
            x_axis,
            y_axis,
            z_axis,
        }
    }

    /// The largest coordinate of the middle, mm.
    pub(super) fn distance(&self) -> f64 {
        self.middle.iter().fold(0.0, |most, c| c.abs().max(most))
    }

    /// A coordinate, in the surface's frame, of the point (x, y, z) of the part's frame.
    #[inline(always)]
    pub(super) fn coordinate<S: Scalar>(&self, axis: usize, x: S, y: S, z: S) -> S {
        x * self.x_axis[axis] + y * self.y_axis[axis] + z * self.z_axis[axis] + self.middle[axis]
    }

    /// How fast the gap between a point and the surface below grows as the point moves along the
    /// part's x, y and z axes, from the surface's slopes there.
    #[inline(always)]
    pub(super) fn rates<S: Scalar>(&self, zx: S, zy: S) -> [S; 3] {
        let along = |axis: Vector| -(zx * axis[0] + zy * axis[1]) + axis[2];
        [along(self.x_axis), along(self.y_axis), along(self.z_axis)]
    }
}

/// The axes of a part whose z axis is the surface's normal, by the shortest rotation.
fn level((slope_x, slope_y): (f64, f64)) -> [Vector; 3] {
    let length = (slope_x * slope_x + slope_y * slope_y + 1.0).sqrt();
    let normal = [-slope_x / length, -slope_y / length, 1.0 / length];
    let share = 1.0 / (1.0 + normal[2]);
    let mixed = -normal[0] * normal[1] * share;
    [
        [1.0 - normal[0] * normal[0] * share, mixed, -normal[0]],
        [mixed, 1.0 - normal[1] * normal[1] * share, -normal[1]],
        normal,
    ]
}

/// The axes of a part onto which the surface is turned about x, then about y.
fn tilted(tilt_x: f64, tilt_y: f64) -> [Vector; 3] {
    let (sin_x, cos_x) = Scalar::sin_cos(tilt_x);
    let (sin_y, cos_y) = Scalar::sin_cos(tilt_y);
    [
        [cos_y, sin_x * sin_y, cos_x * sin_y],
        [0.0, cos_x, -sin_x],
        [-sin_y, sin_x * cos_y, cos_x * cos_y],
    ]
}
