//! How far apart points may lie that a cubic Hermite segment joins: the bound of Wang et al. 2019,
//! eq. 10, on the path that is played. For samplers; a plugin uses it as it stands.
//!
//! φ, mm, is the height of the tool centre along the true spiral as the bound takes it, over the C
//! angle in rad: φ⁗ = Z⁗ − ∂Z/∂X·X⁗, since where X bends its own error moves the place at which Z
//! is compared.

mod bound;
mod samples;
mod steps;

pub use bound::{Bound, Jumps};
pub use steps::{MAX_STEP, SHORTEST, Steps};
