//! Simple laws, for strategies that are asked directly.

use turnpath_core::{Direction, SpiralLaw, Task};

/// The law with one feed over the whole range: of so many turns.
pub fn straight(task: &Task, turns: f64) -> SpiralLaw {
    let (from, to) = match task.direction {
        Direction::Outward => (task.range.inner, task.range.outer),
        Direction::Inward => (task.range.outer, task.range.inner),
    };
    let mut law = SpiralLaw::new();
    law.push(turns, [from, (to - from) / turns, 0.0, 0.0, 0.0, 0.0]);
    law
}
