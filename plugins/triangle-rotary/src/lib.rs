//! PVT velocity solvers: which velocities the controller's cubics take at the control points.

mod analytic;
mod area;
mod linear;
mod spline;
mod three_point;
mod triangle_rotary;

pub use analytic::Analytic;
pub use area::Area;
pub use linear::Linear;
pub use three_point::ThreePoint;
pub use triangle_rotary::TriangleRotary;

turnpath_plugin::export!(velocities: [Analytic, Area, Linear, ThreePoint, TriangleRotary]);
