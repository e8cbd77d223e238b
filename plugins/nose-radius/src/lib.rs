//! Compensators for a round nose in the XZ plane: along z, along the profile's normal, and none.
//!
//! Throughout, g(θ, ρ) is the surface over the polar plane, the nose radius is R, and the radial
//! section at θ has the slope g_ρ and the stretch w = sqrt(1 + g_ρ²).

mod foot;
mod none;
mod normal;
mod polar;
mod scan;
mod z_direction;

pub use none::Uncompensated;
pub use normal::Normal;
pub use z_direction::ZDirection;

turnpath_plugin::export!(compensators: [ZDirection, Normal, Uncompensated]);
