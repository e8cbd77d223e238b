//! PVT velocity solvers: which velocities the controller's cubics take at the control points.

mod analytic;
mod spline;
mod triangle_rotary;

pub use analytic::Analytic;
pub use triangle_rotary::TriangleRotary;

turnpath_plugin::export!(velocities: [Analytic, TriangleRotary]);
