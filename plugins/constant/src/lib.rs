//! The constant feed: one feed per revolution for the whole part.

mod constant;
mod smallest;

pub use constant::Constant;

turnpath_plugin::export!(feeds: [Constant]);
