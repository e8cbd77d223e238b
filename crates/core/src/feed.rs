//! The feed strategy: it gives the spiral law, piece by piece.

use serde::{Deserialize, Serialize};

use crate::{Locus, Result, Task, quintic};

/// What a feed strategy works on: the task and the locus. There is no law yet.
#[derive(Clone, Copy)]
pub struct Setup<'a> {
    /// Part, tool, tolerance, range of ρ, direction, largest spindle speed.
    pub task: &'a Task,
    /// The locus of the nose centre.
    pub locus: &'a dyn Locus,
}

/// Whether a law continues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Continuation {
    /// The law has more pieces.
    More,
    /// The law is complete.
    End,
}

/// Plans the radial parameter ρ as a function of revolutions.
pub trait FeedStrategy: Send + Sync {
    /// Prepares the law. A strategy computes here what it must know of the whole part before the
    /// first piece.
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>>;
}

/// One piece of a spiral law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedPiece {
    /// The number of revolutions that the piece covers.
    pub length: f64,
    /// Coefficients of ρ in mm against the revolutions since the start of the piece, lowest first.
    pub coefficients: [f64; 6],
}

impl FeedPiece {
    /// The polynomial of degree 5 that has a given ρ, dρ/dN and d²ρ/dN² at each end of the piece.
    ///
    /// ```
    /// let smooth = turnpath_core::FeedPiece::between([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0);
    /// assert_eq!(smooth.coefficients, [0.0, 0.0, 0.0, 10.0, -15.0, 6.0]);
    /// ```
    pub fn between(from: [f64; 3], to: [f64; 3], length: f64) -> Self {
        Self {
            length,
            coefficients: quintic(from, to, length),
        }
    }
}

/// A law that is being planned. The host calls it for more pieces until the law is complete.
pub trait FeedPlan: Send {
    /// Appends at least one piece. Pieces for about one revolution or more are a good amount.
    ///
    /// The law begins at N = 0. It begins at the rim if the tool feeds inward, and at the inner end
    /// if the tool feeds outward. The host checks that every turn lies beyond the turn before it.
    ///
    /// If the path must cover the whole part, the host lets the feed run out at both ends. It
    /// leaves an end alone if the law closes there by itself: at every angle, the law's outermost
    /// pass lies beyond the end of the range, or inside of it by at most 0.41 of the distance to
    /// the next pass. The run-out adds up to 0.6 turns at each end, and these turns rotate the rest
    /// of the law against the part. A law that begins at rest is not rotated: it waits for one whole
    /// turn instead. So a law that follows the angle should begin at rest, let the feed grow over the
    /// turns that follow, and continue until the slowest angle has passed the other end.
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation>;
}
