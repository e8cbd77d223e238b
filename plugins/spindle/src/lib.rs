//! Spindles that change their speed: as fast as the machine's limits allow, or as one cutting speed
//! asks.
//!
//! Both strategies have the same parts. `motion` looks at the path once, and keeps the largest
//! derivatives of X and Z in the C angle for each eighth of a turn. A strategy turns them into the
//! largest speed that each eighth allows. `smooth` makes a smooth speed below it, and `law` the
//! pieces of t(N). `limits` checks the pieces against the machine, and `search` keeps the fastest of
//! several schedules. `plan` puts them together.
//!
//! The speed follows whole turns, and not the angle. A speed that is also the fastest within the
//! turn gains a few percent more at most, and ripples.

mod grid;
mod law;
mod limits;
mod motion;
mod per_revolution;
mod plan;
mod search;
mod smooth;
mod surface_speed;

pub use per_revolution::PerRevolution;
pub use surface_speed::SurfaceSpeed;

turnpath_plugin::export!(spindles: [PerRevolution, SurfaceSpeed]);
