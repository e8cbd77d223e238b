//! ATPG, the adaptive tool path generation of Wang et al. 2019: a feed that depends on the radius
//! alone and holds the residual at every angle, and points as far apart as the interpolation
//! tolerance allows.

mod acceleration;
mod bound;
mod cubic;
mod feed;
mod least;
mod pieces;
mod sampler;
mod samples;
mod smooth;
mod table;

pub use cubic::{CubicFit, explicit_pairs};
pub use feed::AtpgFeed;
pub use sampler::AtpgSampler;
pub use table::{FeedTable, Residual};

turnpath_plugin::export!(feeds: [AtpgFeed], samplers: [AtpgSampler]);
