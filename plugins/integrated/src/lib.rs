//! Samplers that place the control points in even steps: of the angle.

mod equal_angle;
mod sharpest;

pub use equal_angle::EqualAngle;

turnpath_plugin::export!(samplers: [EqualAngle]);
