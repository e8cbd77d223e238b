//! FFT-adaptive planning: feed and angle steps from the curvature of the surface, and from its
//! harmonics over a revolution.
//!
//! After W. Zhong, Z. Tong, W. Chen and X. Jiang, *Development of an adaptive toolpath planning
//! strategy for diamond face turning of freeform surfaces*. Straight segments along the radius and
//! along the cut approximate a part. Both are as long as a sagitta e allows on the curve in
//! question (eq. 1): Δs = 2·sqrt(2ϱe − e²), with ϱ the curve's radius of curvature.
//!
//! **Radial (feed).** Profiles lie at θ_i = 2πi/n, all at the revolution's starting radius. Δr_i is
//! Δs projected on the radius. Δr_max = min (2π/θ_i)·Δr_i (eq. 3), and ρ is linear in θ within the
//! revolution (eq. 5). The decisions here are:
//!
//! - *Chord.* With Δs as printed the paper's part takes 61 revolutions. Half of Δs gives the
//!   published 122 exactly. `chord = "half"` is the default here.
//! - *n* is not in the paper. 36 profiles are too few (121 revolutions); 72 or more agree.
//! - *Inward* laws follow the same rule from the rim. The path ends at the range's end, within a
//!   revolution.
//! - *Where nothing is curved* Δr has no limit. The feed is then a tenth of the range.
//! - *No nose.* The paper compensates no nose and promises no residual (its outlook says so).
//!   `limit_residual`, on by default, keeps the feed at or below the one that keeps the residual at
//!   every angle.
//! - e is `tolerance`, or the interpolation tolerance.
//!
//! **Azimuthal (sampler).** z is a function of the arc l = rθ (eq. 4), and Δs follows from its
//! curvature. A step is never longer than Δθ_ct = π/k, where k is the highest harmonic over the
//! revolution whose amplitude 2|F_k|/n is at least e (4096 samples, more if k comes near them).
//! Each revolution begins anew. The decisions here are:
//!
//! - *Curvature.* As printed, the step uses the curvature at its start, along the circle l = r_j θ
//!   through the start. From an inflection such a step continues until Δθ_ct stops it, over crests
//!   that it has not seen: 17,456 points and 3.2 µm, where 20 nm are allowed (360 radial profiles;
//!   with 72 it is 17,316 points and 3.5 µm). The length of such a step depends on how near to an
//!   inflection it begins, so a difference in the last digit grows 10¹²-fold over a turn. Of the
//!   error of such a path only the size is known: at most 3.8 µm, the error of a step from the
//!   inflection itself. `curvature = "step"`, the default, evaluates the curvature over the step
//!   that the start allows, and takes the largest value. With it, half the radial chord and the
//!   whole azimuthal chord, the paper's part takes 21,008 points and errs by 20.0 nm. The published
//!   values are 23,187 points and 26 nm.
//! - *z* is the height of the tool centre along the true spiral, since the controller plays that
//!   height. Without compensation it is the height of the surface, as in the paper. The spectrum is
//!   that of the circle.
//! - Near the axis eq. 1 has no answer (ϱ < e); see `Chord::length`.
//! - The velocity solver decides which segments the controller plays between the points. The
//!   paper's errors are those of straight segments (`linear`). Cubics err far less, so the rule is
//!   a cautious one for them.
//!
//! **What it costs on large parts.** A turn takes ∮ sqrt(|d²z/dθ²|/8e) dθ points. They grow with
//! the radius and with 1/√e, while the points of a cubic (eq. 10 of Wang et al.) grow with the
//! fourth root. On a 213 mm off-axis paraboloid at 10 nm the integral over all turns is 6.56
//! million. The sampler places 6.68 million points, since it looks ahead, and straight segments
//! then err by 10.02 nm. `atpg` takes 373,000 points. The reason is the paper's rule, not a reading
//! of it: the harmonics that reach e are the first few and limit nothing, and the frame is that of
//! the segment's normal, which leaves no tilt to remove. If the controller plays cubics, `atpg` is
//! the sampler for such parts.
//!
//! **The same bytes.** The FFT is that of rustfft, planned without asking the CPU
//! (`FftPlannerScalar`; its SIMD features are off). Only the number k leaves it, and a sum of our
//! own decides k close to the tolerance (`harmonics`).

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
