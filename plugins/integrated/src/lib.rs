//! Samplers that place the control points by the spiral alone: in equal steps of the angle.

mod equal_angle;

pub use equal_angle::EqualAngle;

turnpath_plugin::export!(samplers: [EqualAngle]);
