//! PVT velocity solvers: they choose the velocities of the controller's cubics at the control
//! points.
//!
//! The table shows how the largest error of position falls with the step, measured on uneven steps
//! (`tests/all/orders.rs`), and which nodes a velocity depends on:
//!
//! | solver | order | depends on |
//! |---|---|---|
//! | `analytic` | 4 | its own node |
//! | `triangle-rotary` | 4, natural ends 2 | 64 nodes on either side |
//! | `three-point` | 3 | the next nodes |
//! | `area`, c = ½ | 3, ringing | all nodes before |
//! | `area`, c = ⅔ | 2 | all nodes before, halved from each to the next |
//! | `linear` | 2 | no velocities |
//!
//! **What is published.** `area`, `three-point` and `triangle-rotary` come from the integrated
//! discretization paper on slow tool servo turning, which compares them on a toric surface and a
//! sinusoidal array. Its text describes what they do. The available copy has lost the formulas and
//! the parameters of both surfaces. The decisions here are:
//!
//! - *Area*: the mean velocity of a segment is V_k + c(V_{k+1} − V_k), derived from the paper's
//!   description. It gives the published pattern. c < ½ would let errors grow and is refused.
//! - *Three-point*: the parabola through a node and its neighbours, with exact rates at the path's
//!   ends.
//! - *Triangle rotary*: continuous acceleration, a tridiagonal matrix, the "chasing method": the C²
//!   cubic spline. The paper has natural ends, which err by the square of the last steps (840 nm
//!   where the rest errs by 1.5 nm). `ends = "clamped"`, with exact rates, is the default.
//! - Times are as uneven as the steps, so the formulas are those for uneven nodes.
//!
//! `analytic` is the rate that Wang et al. 2019 assume for their bound, eq. 10. `linear` has the
//! straight segments with which Zhong et al. measure. docs/reproduction.md compares the figures.

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
