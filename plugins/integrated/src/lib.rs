//! Samplers that place the control points in even steps: of the angle, of the arc, or of whichever
//! is smaller.
//!
//! After the integrated discretization paper on slow tool servo turning (PVT velocities by the
//! triangle rotary method), which compares the three. Its Fig. 10 shows the interpolation error
//! against the radius: equal angles are worst at the rim, equal arcs are worst near the centre, and
//! the integrated method takes the better of both.
//!
//! The available copy of the paper has lost the text of the discretization formulas, the figure's
//! scales and the toric surface's radii. Its case has 5° steps, 1 mm of arc, Ø 40 mm and 0.05
//! mm/rev. The decisions here are:
//!
//! - The arc is that of the spiral seen from above, ∫ sqrt(ρ² + ρ_θ²) dθ. The slope of the surface
//!   does not count, so the nodes do not depend on it.
//! - The arc continues over revolutions and blocks from the path's first point. Samplers of arcs
//!   are therefore `Sequential`, with the next node as their state.
//! - Near the centre an arc may be longer than a turn: `equal-arc` limits a step to 90°, and
//!   `integrated` limits it to its `max_step`. So `integrated` is `equal-arc` with a smaller
//!   largest step: where the arc would span more than that step, it takes equal angles.
//! - `equal-angle` without a step takes the largest step that keeps the tolerance at the path's
//!   sharpest point. Arcs must always be given.

mod arc;
mod equal_angle;
mod equal_arc;
mod integrated;
mod sharpest;

pub use equal_angle::EqualAngle;
pub use equal_arc::EqualArc;
pub use integrated::Integrated;

turnpath_plugin::export!(samplers: [EqualAngle, EqualArc, Integrated]);
