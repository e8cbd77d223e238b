//! The sampler `minimax`: the fewest points whose cubics keep the interpolation tolerance as played.
//!
//! A cubic with exact values and rates at both ends errs to one side only. For a path with a
//! constant φ⁗ the longest such step has L⁴φ⁗ = 384ε. Where values and rates may leave the path, the
//! error uses the tolerance on both sides, and the longest step has L⁴φ⁗ = 768ε: its ends lie ε off
//! the path, with exact rates. A cubic without any continuity would have 3072ε.
//!
//! - **Played error.** A step is judged by the error of its own cubic and not by a bound. The exact
//!   path is tabulated once in each block (`table`), and the error of a trial step is compared with
//!   the tolerance at all places of the table (`segment`). Z may accelerate little more than on a path
//!   with all nodes on the locus (`acceleration`). Cubics are played in time. So where the
//!   spindle changes its speed or X moves, the error is e_Z − Z_θ·e_C − Z_X·e_X.
//! - **Room.** Where X moves within the turn, its own error is held to what the cusps leave room for
//!   (`room`), so that refinement need not halve steps.
//! - **Shortest path.** A node is in one of a few states (α, β): it lies αε above the locus, and its
//!   rate is βε/h larger, with h the natural step there. The states of one node are tried against
//!   those of the next, and the chain that gets furthest with each number of nodes is kept
//!   (`search`). With one state all nodes lie on the locus.
//! - **Blocks.** A block begins and ends on the locus, so blocks do not depend on each other. A knot
//!   of the law across which no step can be long is a border too (`spans`).
//! - **Wandering.** Steps as long as the largest one come round in 64 turns, where their errors would
//!   stand as spokes (`wandering`).
//! - **Aim.** Steps aim at 0.98 of the tolerance. Refinement stays behind them.

mod acceleration;
mod clock;
mod grid;
mod natural_steps;
mod place;
mod reach;
mod room;
mod sampler;

mod search;
mod segment;
mod spans;
mod state;
mod table;
mod wandering;

pub use sampler::MinimaxSampler;

turnpath_plugin::export!(samplers: [MinimaxSampler]);
