//! How far apart points may lie that a cubic Hermite segment joins: the bound of Wang et al. 2019,
//! eq. 10, on the path that is played. For samplers; a plugin uses it as it stands.

mod bound;
mod samples;
mod steps;

pub use bound::{Bound, Jumps};
pub use steps::{MAX_STEP, SHORTEST, Steps};
