//! The constant feed: one feed per revolution for the whole part.
//!
//! The conventional path that all papers compare with. Wang et al. 2019 have its feed from "the
//! minimum radius of curvature of the part" (8.9 µm for their mirror of 50 mm) without a formula;
//! Zhong et al. give 10 µm, the integrated discretization paper 50 µm. What was decided: `feed` is
//! taken as given; without it, it is the smallest feed on the part that holds the residual, with
//! nose and slope reckoned as for `atpg`. On AST-5 that makes 101.1 revolutions along the contact,
//! the 101 whole ones behind that paper's 6061 points of 6°.

mod constant;
mod smallest;

pub use constant::Constant;

turnpath_plugin::export!(feeds: [Constant]);
