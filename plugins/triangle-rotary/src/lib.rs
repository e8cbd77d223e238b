//! PVT velocity solvers: which velocities the controller's cubics take at the control points.
//!
//! How the largest error of position falls with the step, measured on uneven steps
//! (`tests/orders.rs`), and how far a velocity looks:
//!
//! | solver | order | depends on |
//! |---|---|---|
//! | `analytic` | 4 | its own node |
//! | `triangle-rotary` | 4, natural ends 2 | 64 nodes on either side |
//! | `three-point` | 3 | the next nodes |
//! | `area`, c = ½ | 3, ringing | all nodes before |
//! | `area`, c = ⅔ | 2 | all nodes before, halved from each to the next |
//! | `linear` | 2 | no velocities |

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
