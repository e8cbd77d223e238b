//! The constant feed, one feed per revolution for the whole part, and the constant spindle.
//!
//! The constant feed is the conventional path with which all papers compare. Wang et al. 2019 take
//! its feed from "the minimum radius of curvature of the part" (8.9 µm for their mirror of 50 mm),
//! without a formula. Zhong et al. give 10 µm, and the integrated discretization paper 50 µm. The
//! decision here is: if the recipe gives `feed`, the strategy uses it as it is. Without `feed` it
//! takes the smallest feed on the part that keeps the residual, with nose and slope computed as for
//! `atpg`. A large feed is that of the exact cusp at the radius halfway between two passes. On AST-5
//! this makes 101.1 revolutions along the contact, which agrees with the 101 whole ones behind that
//! paper's 6061 points of 6°.

mod constant;
mod smallest;
mod speed;

pub use constant::Constant;
pub use speed::ConstantSpeed;

turnpath_plugin::export!(feeds: [Constant], spindles: [ConstantSpeed]);
