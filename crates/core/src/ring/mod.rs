//! What a ring of angles says of its radius: the smallest of a quantity over all angles, and the
//! smallest held feed tabulated over the radius. For feeds whose rate does not follow the angle.

mod least;
mod table;

pub use least::{Measure, least_over_angles};
pub use table::{FLOORS, FeedAt, FeedTable};
