//! Minima over a ring of angles: the smallest value of a quantity over all angles of a radius, and
//! a table of the smallest residual feed against the radius. Feeds that do not depend on the angle
//! use them.

mod least;
mod table;

pub use least::{Measure, least_over_angles, least_over_angles_at};
pub use table::{FLOORS, FeedAt, FeedTable, RADII_AT_ONCE, least_feeds_at};
