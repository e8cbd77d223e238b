//! The feed strategy: the spiral law, block by block.

use crate::{Locus, Result, Task, quintic};

/// The task and the locus, before there is a law.
#[derive(Clone, Copy)]
pub struct Setup<'a> {
    /// Part, tool, tolerance, range of ρ, direction, spindle.
    pub task: &'a Task,
    /// Where the nose centre goes.
    pub locus: &'a dyn Locus,
}

/// Whether a law goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Continuation {
    /// There is more to come.
    More,
    /// The law has reached its end.
    End,
}

/// Plans how far the tool feeds against revolutions.
pub trait FeedStrategy: Send + Sync {
    /// Prepares the law: whatever must be known of the whole part before its first piece.
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>>;
}

/// One piece of a law in the making.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedPiece {
    /// How many revolutions it covers.
    pub length: f64,
    /// Coefficients of ρ in mm against the revolutions since its start, lowest first.
    pub coefficients: [f64; 6],
}

impl FeedPiece {
    /// The polynomial of degree 5 with a given ρ, dρ/dN and d²ρ/dN² at each of its ends.
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

/// A law in the making: a state of one's own, asked for the next pieces until it is done.
pub trait FeedPlan: Send {
    /// Appends at least one piece; about a revolution's worth or more is a good measure.
    ///
    /// The law begins at N = 0 at the rim (inward) or at the inner end (outward). The host checks
    /// that every turn lies beyond the last.
    ///
    /// Where the path is to cover the whole part, the host lets the feed run out at both ends, unless
    /// the law closes there by itself: at every angle its outermost pass lies beyond the end of the
    /// range, or inside of it by no more than 0.41 of the way to the next pass. Running out adds up
    /// to 0.6 turns an end, which turns the rest of the law against the part. So a law that
    /// follows the angle must close by itself, at N = 0 also: begin with a turn that hardly leaves
    /// the end of the range, let the feed come in over the turns that follow, and go on until the
    /// slowest angle has passed the other end.
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation>;
}
