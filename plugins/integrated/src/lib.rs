//! Samplers that place the control points in even steps: of the angle, of the arc, or of whichever
//! is smaller.
//!
//! After the integrated discretization paper on slow tool servo turning (PVT velocities by the
//! triangle rotary method), which compares the three. Its Fig. 10 shows how the interpolation error
//! goes with the radius: equal angles are worst at the rim, equal arcs near the centre, and the
//! integrated method takes the better of both.
//!
//! The text of the discretization formulas is lost in the copy at hand, as are the figure's scales and
//! the toric surface's radii; its case has 5° steps, 1 mm of arc, Ø 40 mm and 0.05 mm/rev. What was
//! decided:
//!
//! - Arc is that of the spiral seen from above, ∫ sqrt(ρ² + ρ_θ²) dθ; the slope of the surface does
//!   not count, so the nodes do not depend on it.
//! - The arc goes on over revolutions and blocks from the path's first point: samplers of arcs are
//!   `Sequential`, with the next node as their state.
//! - Near the centre an arc may be longer than a turn: `equal-arc` stops at 90°, `integrated` at its
//!   `max_step`. So the latter is the former with a smaller largest step: where the arc would span
//!   more than that, steps are of equal angles.
//! - `equal-angle` without a step takes the largest that holds the tolerance at the worst place;
//!   arcs are always given.

mod arc;
mod equal_angle;
mod equal_arc;
mod integrated;
mod sharpest;

pub use equal_angle::EqualAngle;
pub use equal_arc::EqualArc;
pub use integrated::Integrated;

turnpath_plugin::export!(samplers: [EqualAngle, EqualArc, Integrated]);
