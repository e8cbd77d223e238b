//! ATPG, the adaptive tool path generation of Wang et al. 2019. Its feed depends on the radius
//! alone and keeps the residual at every angle. Its points lie as far apart as the interpolation
//! tolerance allows.
//!
//! After *Adaptive Spiral Tool Path Generation for Diamond Turning of Large Aperture Freeform
//! Optics*, §3.2 to §3.4.
//!
//! **Feed.** Contacts may be L = sqrt(8Rε/(1 − Rκ)) apart along the profile (eq. 2), and f = L/w
//! (eq. 4), with the extremes of curvature and slope over all angles of a radius. The law goes
//! through explicit pairs ρ_{i+1} = ρ_i + f_i (eq. 5). A smooth curve joins them; in the paper's
//! example it is a cubic (eq. 19). The paper has misprints, and it leaves some decisions open:
//!
//! - *Eq. 1* has 1 + g_ρ where the curvature has 1 + g_ρ². *Eq. 3* takes the smallest slope where
//!   it means the largest |slope|. AST-5's "amplitude 1 mm" is peak to valley. With these
//!   corrections eq. 19 comes out to all its digits.
//! - *The spacing.* Eq. 2 is the spacing of contacts. With compensation along z the feed is the
//!   spacing of the centres, which are closer by 1 − Rκ. As printed, cusps on hollows are ε/(1 −
//!   Rκ)² (AST-5: 105 nm for 100). `residual = "held"`, the default, takes sqrt(8Rε(1 − Rκ))/w
//!   there, and the smallest feed over the angles. `"paper"` is the printed feed, with the extremes
//!   of curvature and slope taken separately.
//! - *The fit.* The curve should not exceed the pairs, but a least-squares cubic does (it exceeds
//!   the residual by 0.2 % on AST-5 and by 46 % on a strong array). `fit = "smooth"`, the default,
//!   stays below by construction (`smooth`). `"cubic"` is the paper's fit, from the root of ℓ = the
//!   inner radius.
//!
//! **Sampler.** ε ≥ L⁴/384 max |φ⁗| over the step (eq. 10). In the paper φ is the height along the
//! circle at the contact's radius, and the nose is compensated afterwards. The decisions here are:
//!
//! - φ is the tool centre's height along the true spiral, since the controller plays that height.
//!   Nodes of the contact curve, used for a compensated tool, err more than three times as much on
//!   AST-5.
//! - The maximum is that of the whole step. The largest step is `max_step`. The paper does not
//!   state its largest step (9° fits its 3,920 points; eq. 10 alone would need 1,700).
//! - Eq. 10 is a bound for exact rates. The solver decides which velocities are played, and
//!   refinement adds the points that these velocities need.
//! - Steps continue across revolutions. The error of X's own interpolation has a bound too.
//!
//! The paper does not state the tolerances of the parts that it cut: docs/reproduction.md has what
//! follows from that.

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
