//! FFT-adaptive planning: feed and angle steps from the curvature of the surface, and from its
//! harmonics over a revolution.
//!
//! After W. Zhong, Z. Tong, W. Chen and X. Jiang, *Development of an adaptive toolpath planning
//! strategy for diamond face turning of freeform surfaces*. A part is approximated by straight
//! segments along the radius and along the cut; both are as long as a sagitta e allows on the curve
//! at hand (eq. 1), Δs = 2·sqrt(2ϱe − e²), ϱ its radius of curvature.
//!
//! **Radial (feed).** Profiles at θ_i = 2πi/n, all at the revolution's starting radius; Δr_i is Δs
//! projected on the radius; Δr_max = min (2π/θ_i)·Δr_i (eq. 3), ρ linear in θ within the revolution
//! (eq. 5). What was decided:
//!
//! - *Chord.* With Δs as printed the paper's part takes 61 revolutions; half of it gives the
//!   published 122 exactly. `chord = "half"` is the default here.
//! - *n* is not said. 36 profiles are too few (121 revolutions); 72 or more agree.
//! - *Inward* is the same from the rim; the path ends at the range's end within a revolution.
//! - *Where nothing is curved* Δr has no bound; a tenth of the range is taken.
//! - *No nose.* The paper compensates none and promises no residual (its outlook says so).
//!   `limit_residual`, on by default, keeps the feed at or below what holds it at every angle.
//! - e is `tolerance`, or the interpolation tolerance.
//!
//! **Azimuthal (sampler).** z over the arc l = rθ (eq. 4), Δs from its curvature, and never more
//! than Δθ_ct = π/k, k the highest harmonic over the revolution whose amplitude 2|F_k|/n is at
//! least e (4096 samples, more where k comes near them). Each revolution begins anew. What was
//! decided:
//!
//! - *Curvature.* As printed, the step goes by the curvature at its start, along the circle
//!   l = r_j θ through it: from an inflection it goes on until Δθ_ct stops it, over crests that it
//!   has not seen: 17,456 points and 3.2 µm where 20 nm are wanted (360 radial profiles; with 72
//!   17,316 and 3.5 µm). How far such a step goes hangs on how near to an inflection it begins, so
//!   a difference in the last digit grows 10¹²-fold over a turn: the error of a path is known to
//!   its size, at most 3.8 µm, that of a step from an inflection itself.
//!   `curvature = "step"`, the default, looks over the step that the start allows, and takes the
//!   largest curvature on it. With it, half the radial chord and the whole azimuthal one, the
//!   paper's part takes 21,008 points and errs by 20.0 nm; published are 23,187 and 26 nm.
//! - *z* is the tool centre's along the true spiral, since that is what is played; without
//!   compensation it is the surface's, as in the paper. The spectrum is that of the circle.
//! - Near the axis eq. 1 has no answer (ϱ < e); see `Chord::length`.
//! - Segments between the points are whatever the velocity solver plays. The paper's errors are of
//!   straight ones (`linear`); cubics err far less, so the rule is a cautious one for them.
//!
//! **What it costs on large parts.** A turn takes ∮ sqrt(|d²z/dθ²|/8e) dθ points: they grow with the
//! radius and with 1/√e, where those of a cubic (eq. 10 of Wang et al.) grow with the fourth root.
//! On a 213 mm off-axis paraboloid at 10 nm that integral over all turns is 6.56 million; the
//! sampler places 6.68 million, since it looks ahead, and straight segments then err by 10.02 nm;
//! `atpg` takes 373,000. It is the paper's rule, not a reading of it: the harmonics that reach e are
//! the first few and bind nothing, and the frame is that of the segment's normal, which leaves no
//! tilt to take off. Where cubics are played, `atpg` is the sampler for such parts.
//!
//! **Sameness.** The FFT is rustfft's, planned without asking the CPU (`FftPlannerScalar`; its SIMD
//! features are off). Only the count k comes out of it, and close to the tolerance that is decided
//! by a sum of our own (`harmonics`).

mod chord;
mod feed;
mod harmonics;
mod printed;
mod revolution;
mod rule;
mod sampler;

pub use feed::FftAdaptiveFeed;
pub use sampler::FftAdaptiveSampler;

turnpath_plugin::export!(feeds: [FftAdaptiveFeed], samplers: [FftAdaptiveSampler]);
