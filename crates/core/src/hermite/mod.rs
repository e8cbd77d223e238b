//! How far apart points may lie that a cubic Hermite segment joins: the bound of Wang et al. 2019,
//! eq. 10, on the played path. Samplers use it; a plugin can use it as it is.
//!
//! φ, mm, is the height of the tool centre along the true spiral as the bound takes it, over the C
//! angle in rad. φ⁗ = Z⁗ − ∂Z/∂X·X⁗: where X bends, the error of X itself moves the position at
//! which Z is compared. Where the speed of the spindle changes, the cubics run in time, and the bound
//! takes the derivatives in time, without what C's own error makes of them.

mod bound;
mod clock;
mod estimate;
mod knots;
mod phi;
mod samples;
mod steps;
mod swing;

pub use bound::{Bound, Jumps};
pub use phi::{LEAST_PITCH, pitch};
pub use steps::{FEED_PART, MAX_STEP, SHORTEST, Steps, WANDER, largest_step};
pub use swing::x_swings;
