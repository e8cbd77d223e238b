//! ATS, adaptive tool servo: feed and angle step both follow the shape at every cutting point.
//!
//! **What is available.** Of the paper (Zhu and To 2015, Optics Express 23, 20234–20248) we have
//! only the abstract and the account in Wang et al. 2019: angle and feed adapt to the shape of the
//! surface at every cutting point, and the resulting path is irregular. We have none of its
//! formulas, and no figure of its examples. So nothing here is compared with the paper itself. The
//! law is derived, and it is compared with cusps that are found by brute force.
//!
//! **The feed.** ℓ(N + 1) = ℓ(N) ± f, where f is the feed that keeps the residual at that position
//! and angle. The path leaves the circle ρ₀ by ℓ(N + 1) = ℓ(N) ± q(N)·f. q is two quintics from 0
//! to 1, such that ρ and its first two derivatives are continuous across every whole turn; the
//! third derivative jumps there. The decisions are:
//!
//! - q rises over two turns, not over one. What one turn does to ρ', every later turn repeats. With
//!   a smoothstep over one turn, from rest to rest, X would come to a stop once in each turn on a
//!   part of any shape (a sphere of 50 mm cut at 500 rpm then takes 10 mm/s² RMS of X, where 3e-5
//!   are enough). Over two turns, with q'(u) + q'(1 + u) = 1, the rate is even where nothing
//!   follows the angle, and the path still begins at rest. The first turn stays within 0.4 feeds of
//!   ρ₀, so the edge is cut at every angle.
//! - f is evaluated in the middle of the step, at ρ ± ½f, where the cusp stands. With f at the
//!   start of the step, the cusps would exceed the tolerance by f_ρ wherever the feed falls along
//!   the cut.
//! - Feeds above R/25 follow the exact cusp between noses, as far as these meet within their edges.
//!   The cap there is smooth. f stays 0.15 % below the feed that keeps the residual, which leaves
//!   room for X's own interpolation.
//! - The law is returned as pieces of degree 5 that have the recursion's exact ρ and two
//!   derivatives at both ends (from the surface's mixed derivatives up to the 4th, by five Taylor
//!   series at each point). A turn has 24 pieces or more, until no piece strays by more than 1e-5
//!   of a feed. One turn is the whole state.
//! - The law ends one turn after the last point that falls short of the range's end: then the
//!   slowest angle has passed too. By then fast angles have gone beyond the end (AST-5: up to 0.5
//!   mm), so the surface must have a height there. ρ begins exactly at the range's other end.
//! - Inward, the law is the recursion in the direction of cutting, from the rim's circle. It is not
//!   the outward law reversed, whose ρ would differ from angle to angle at the rim. The angles
//!   drift apart on the way, so at the centre fast ones reach ρ = 0 while slow ones are still
//!   outside. The fast ones continue to negative ρ, where f is that of the other side, and the law
//!   ends when every angle is at or below the inner end. What they pass there is already cut, but X
//!   crosses the axis (AST-5: by 0.48 mm), where the part moves against the edge.
//! - `inward = "backwards"` is for machines and tools that cannot do that. It is the outward law of
//!   angles that run the other way, ρ(N) = ℓ(N_end − N) over whole turns. It closes at the axis, at
//!   rest on the circle of the inner end at every angle. The price is at the rim, where it begins
//!   as far outside as the outward law ends (AST-5: 0.5 mm), in the air. Feeds, cusps and X's
//!   acceleration are those of the outward law. The whole law is kept in memory, 56 bytes a piece.
//! - To stop fast angles at the axis within the recursion would take X from 25 mm/s to rest within
//!   one feed on AST-5: 12 m/s² in every turn, against 5 at most elsewhere. To slow them down from
//!   further out is a law of the radius, and `atpg` is that law.
//!
//! **What it costs.** X moves back and forth within each turn. On AST-5 (500 rpm, outward) it takes
//! 1.1 m/s² RMS, where ATPG's law takes 1.5 µm/s²; on OAP-213 it takes 29 mm/s². If one angle is
//! the slowest at all radii, as on an astigmatic part, ATS saves no turn: that angle alone decides
//! how many there are.
//!
//! **The sampler** is the bound of Wang et al., eq. 10, on the played path, for X and Z together:
//! φ⁗ = Z⁗ − ∂Z/∂X·X⁗, with X's own error measured against the distance between passes
//! (`turnpath_plugin::hermite`).

mod feed;
mod jet;
mod residual_feed;
mod sampler;
mod sections;
mod turn;

pub use feed::AtsFeed;
pub use sampler::AtsSampler;

turnpath_plugin::export!(feeds: [AtsFeed], samplers: [AtsSampler]);
