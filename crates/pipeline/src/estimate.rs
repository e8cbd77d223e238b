//! How long a path will be, before it is made.

use rayon::prelude::*;

use crate::Result;
use crate::feed_cap::{FeedCap, feed_cap};
use crate::order::one_at_a_time;
use crate::plan::Plan;

/// About how many blocks are looked at to estimate the count of control points.
const COUNTED_BLOCKS: usize = 8;

/// What a run will give, without leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Revolutions.
    pub revolutions: f64,
    /// Time, s.
    pub cutting_time: f64,
    /// Control points, from a few blocks: of a run as the sampler places them, of a sample as refinement
    /// leaves them.
    pub control_points: f64,
    /// Where the reach of the nose sets the feed; `None` where it does so nowhere.
    pub feed_cap: Option<FeedCap>,
}

impl Estimate {
    /// The estimate of a plan.
    pub(crate) fn of(plan: &Plan<'_>, nodes_per_revolution: f64) -> Result<Self> {
        let revolutions = plan.law.end();
        Ok(Self {
            revolutions,
            cutting_time: plan.spindle.time_at(revolutions),
            control_points: nodes_per_revolution * revolutions + 1.0,
            feed_cap: feed_cap(plan.preparation, &plan.law)?,
        })
    }
}

/// Mean count of the sampler's nodes on a revolution, from a few blocks.
pub fn nodes_per_revolution(plan: &Plan<'_>) -> Result<f64> {
    let every = plan.blocks().div_ceil(COUNTED_BLOCKS).max(1);
    let mut chosen: Vec<usize> = (0..plan.blocks()).step_by(every).collect();
    let turns = chosen.iter().map(|index| plan.revolutions(*index));
    let turns: f64 = turns.map(|block| block.end - block.start).sum();
    // The outermost first: blocks take longer the further out they are, and a long one that begins last
    // keeps the other threads waiting.
    let radius = |index: &usize| plan.law.value(plan.revolutions(*index).start).abs();
    chosen.sort_by(|one, other| radius(other).total_cmp(&radius(one)));
    let counts = chosen.par_iter().map(|index| plan.nodes(*index));
    let counts = one_at_a_time(counts.map(|nodes| nodes.map(|nodes| nodes.len() as f64)))?;
    Ok(counts.iter().sum::<f64>() / turns)
}
