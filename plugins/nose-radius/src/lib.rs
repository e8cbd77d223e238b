//! Compensators for a round nose in the XZ plane: along z, along the profile's normal, and none.
//!
//! Throughout, g(θ, ρ) is the surface over the polar plane, R is the nose radius, and the radial
//! section at θ has the slope g_ρ and the slant w = sqrt(1 + g_ρ²). The rake is zero.
//!
//! **What is published.** Wang et al. 2019 compensate along z so that X stays even. The foot
//! follows from its distance R to the centre and from the normal there, by Newton's method (eq. 15
//! to 18). The integrated discretization paper has both ways, and finds that X oscillates with the
//! normal; it interpolates its shifted points by a spline along z. The decisions here are:
//!
//! - Eq. 16 holds wherever the circle touches, and with both signs of the normal. `z-direction` is
//!   the first touch from above, which is the highest such centre. Where the nose fits (Rκ < 1)
//!   there is exactly one such centre; it has a bracket, and Newton's steps are safeguarded.
//! - Nothing is interpolated. Each centre is solved for at its own X, and rates and series follow
//!   from the foot exactly.
//! - `normal` is in closed form, X = ρ − R g_ρ/w, Z = g + R/w. Its X oscillates as published.
//! - `none` plays the contact, as Zhong et al. do, who leave the nose to future work.
//! - Profiles continue through the axis and beyond the rim as the surface's formula gives them:
//!   neither paper says what the nose meets there.

mod descent;
mod foot;
mod none;
mod normal;
mod polar;
mod scan;
mod search;
mod touch;
mod z_direction;

pub use none::Uncompensated;
pub use normal::Normal;
pub use z_direction::ZDirection;

turnpath_plugin::export!(compensators: [ZDirection, Normal, Uncompensated]);
