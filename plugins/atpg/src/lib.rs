//! ATPG, the adaptive tool path generation of Wang et al. 2019: a feed that depends on the radius
//! alone and holds the residual at every angle, and points as far apart as the interpolation
//! tolerance allows.
//!
//! After *Adaptive Spiral Tool Path Generation for Diamond Turning of Large Aperture Freeform
//! Optics*, §3.2 to §3.4.
//!
//! **Feed.** Contacts may be L = sqrt(8Rε/(1 − Rκ)) apart along the profile (eq. 2), f = L/w (eq. 4),
//! with the extremes of curvature and slope over all angles of a radius; explicit pairs
//! ρ_{i+1} = ρ_i + f_i (eq. 5), and a smooth curve through them, a cubic in the example (eq. 19).
//! What is misprinted, and what was decided:
//!
//! - *Eq. 1* has 1 + g_ρ where the curvature has 1 + g_ρ². *Eq. 3* takes the smallest slope where the
//!   largest |slope| is meant. AST-5's "amplitude 1 mm" is peak to valley. So read, eq. 19 comes out
//!   to all its digits.
//! - *Which spacing.* Eq. 2 spaces contacts. With compensation along z it is the centres that the
//!   feed spaces, and these are closer by 1 − Rκ: as printed, cusps are ε/(1 − Rκ)² on hollows
//!   (AST-5: 105 nm for 100). `residual = "held"`, the default, takes sqrt(8Rε(1 − Rκ))/w there, and
//!   the smallest feed over the angles; `"paper"` is the printed one, curvature and slope each with
//!   its own extreme.
//! - *The fit.* The curve should not exceed the pairs, and a least-squares cubic does (residual by
//!   0.2 % on AST-5, by 46 % on a strong array). `fit = "smooth"`, the default, stays below by
//!   construction (`smooth`); `"cubic"` is the paper's, from the root of ℓ = the inner radius.
//!
//! **Sampler.** ε ≥ L⁴/384 max |φ⁗| over the step (eq. 10), φ the height along the circle at the
//! contact's radius, the nose compensated afterwards. What was decided:
//!
//! - φ is the tool centre's height along the true spiral, since that is what is played: nodes of the
//!   contact curve under a compensated tool err more than three times as much on AST-5.
//! - The maximum is that of the whole step. The largest step is `max_step`; the paper's is not
//!   stated (9° fits its 3,920 points, where eq. 10 alone would do with 1,700).
//! - Eq. 10 is a bound for exact rates. Which velocities are played is the solver's matter, and
//!   what they need more is refinement's.
//! - Steps go on over revolutions. X's own interpolation is bounded too.
//!
//! Tolerances of the parts that were cut are not stated: docs/reproduction.md has what follows.

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
