//! ATS, adaptive tool servo: feed and angle step both follow the shape at every cutting point.
//!
//! **What is at hand.** Of the paper (Zhu and To 2015, Optics Express 23, 20234–20248) only the
//! abstract, and the account that Wang et al. 2019 give of it: angle and feed are adjusted at any
//! cutting point to the shape of the surface, and the path that results is irregular. None of its
//! formulas, and no figure of its examples. So nothing here is held against the paper itself; the
//! law is derived, and held against cusps by brute force.
//!
//! **The feed.** ℓ(N + 1) = ℓ(N) ± f, with f the feed that holds the residual at that place and
//! angle. The path leaves the circle ρ₀ by ℓ(N + 1) = ℓ(N) ± q(N)·f, q two quintics from 0 to 1, such
//! that ρ and its first two derivatives go on across every whole turn; the third jumps there. What
//! was decided:
//!
//! - q rises over two turns, not over one. What one turn does to ρ' every turn after it repeats: with
//!   a smoothstep over one, from rest to rest, X comes to a stop once a turn on a part of any shape (a
//!   sphere of 50 mm cut at 500 rpm then takes 10 mm/s² RMS of X, where 3e-5 do). Over two, with
//!   q'(u) + q'(1 + u) = 1, the rate is even where nothing follows the angle, and the path still
//!   begins at rest. The first turn stays within 0.4 feeds of ρ₀: the edge is cut at every angle.
//! - f is taken in the middle of the step, at ρ ± ½f, where the cusp stands. With f at its start
//!   the cusps would exceed the tolerance by f_ρ wherever the feed falls along the cut.
//! - The cap at R/10 is a smooth one, and f keeps 0.15 % below what holds, the room of X's own
//!   interpolation.
//! - The law is handed out as pieces of degree 5 that have the recursion's exact ρ and two
//!   derivatives at both ends (from the surface's mixed derivatives up to the 4th, by five Taylor
//!   series a place), 24 or more a turn, until none strays by more than 1e-5 of a feed. One turn is
//!   all the state.
//! - It ends a turn after the last place that falls short of the range's end: then the slowest angle
//!   has passed too. Fast angles have gone beyond by then (AST-5: up to 0.5 mm), so the surface must
//!   have a height there. ρ begins at the range's other end exactly.
//! - Inward is the recursion in the direction of cutting, from the rim's circle, and not the outward
//!   law reversed, whose ρ would differ from angle to angle at the rim. The angles drift apart on the
//!   way, so at the centre fast ones reach ρ = 0 while slow ones are still outside. They go on to
//!   negative ρ, where f is that of the other side, and the law ends when every angle is at or
//!   below the inner end. What they pass there has been cut already, but X crosses the axis (AST-5:
//!   by 0.48 mm), where the part moves against the edge.
//! - `inward = "backwards"` is for machines and tools that do not stand that: the outward law of
//!   angles that run the other way, ρ(N) = ℓ(N_end − N) over whole turns. It closes at the axis, at
//!   rest on the circle of the inner end at every angle, and pays for it at the rim, where it begins
//!   as far outside as the outward law ends (AST-5: 0.5 mm), in the air. Feeds, cusps and X's
//!   acceleration are those of the outward law; the whole law is kept, 56 bytes a piece.
//! - To stop fast angles at the axis within the recursion would take X from 25 mm/s to rest within a
//!   feed on AST-5, 12 m/s² in every turn against 5 at the most elsewhere; to slow them down from
//!   further out is a law of the radius, which `atpg` is.
//!
//! **What it costs.** X moves back and forth within each turn. AST-5 (500 rpm, outward): 1.1 m/s² RMS
//! where ATPG's law has 1.5 µm/s²; OAP-213: 29 mm/s². Where one angle is the slowest at all radii, as on an astigmatic
//! part, ATS saves no turn: that angle alone says how many there are.
//!
//! **The sampler** is the bound of Wang et al., eq. 10, on the path that is played, for X and Z
//! together: φ⁗ = Z⁗ − ∂Z/∂X·X⁗, and X's own error against the distance of passes
//! (`turnpath_plugin::hermite`).

mod feed;
mod held;
mod jet;
mod sampler;
mod sections;
mod turn;

pub use feed::AtsFeed;
pub use sampler::AtsSampler;

turnpath_plugin::export!(feeds: [AtsFeed], samplers: [AtsSampler]);
