//! The blocks of a path one after the other, each with its joint closed.

use crate::Result;
use crate::make::{BlockPoints, Depths, close_joints, first_state, make};
use crate::plan::Plan;

/// The blocks that are still to come, and what the next one needs of those before.
pub struct Blocks {
    /// How many are made at a time.
    batch: usize,
    /// The first one that is not made yet.
    next: usize,
    /// A block that waits for the first point of the next one.
    waiting: Option<BlockPoints>,
    /// The state of a sequential solver.
    solver_state: Option<Vec<f64>>,
}

impl Blocks {
    /// All blocks of a path.
    pub fn of(plan: &Plan<'_>, batch: usize) -> Self {
        Self {
            batch,
            next: 0,
            waiting: None,
            solver_state: first_state(plan),
        }
    }

    /// How many are still to come.
    pub fn left(&self, plan: &Plan<'_>) -> usize {
        plan.blocks() - self.next + usize::from(self.waiting.is_some())
    }

    /// Makes the next blocks, with their segments halved so often; `None` at the end of the path. The
    /// last one that is made waits for the next call.
    pub fn next(&mut self, plan: &Plan<'_>, depths: &[Depths]) -> Result<Option<Vec<BlockPoints>>> {
        let range = self.next..plan.blocks().min(self.next + self.batch);
        if range.is_empty() {
            return Ok(None);
        }
        self.next = range.end;
        let mut blocks: Vec<BlockPoints> = self.waiting.take().into_iter().collect();
        blocks.extend(make(plan, range, depths, self.solver_state.as_mut())?);
        close_joints(&mut blocks);
        if self.next < plan.blocks() {
            self.waiting = blocks.pop();
        }
        Ok(Some(blocks))
    }
}
