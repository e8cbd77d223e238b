//! ATPG, the adaptive tool path generation of Wang et al. 2019: a feed that depends on the radius
//! alone and holds the residual at every angle, and points as far apart as the interpolation
//! tolerance allows.

mod acceleration;
mod cubic;
mod feed;
mod pieces;
mod residual;
mod sampler;
mod smooth;

pub use cubic::{CubicFit, explicit_pairs};
pub use feed::AtpgFeed;
pub use residual::Residual;
pub use sampler::AtpgSampler;

turnpath_plugin::export!(feeds: [AtpgFeed], samplers: [AtpgSampler]);
