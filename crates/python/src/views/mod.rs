//! What a strategy of Python may ask during its call, in mm, rad, s and revolutions.

pub mod cut;
pub mod locus;
pub mod path;
pub mod task;
