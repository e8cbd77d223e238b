//! The job of a recipe, before the range of ρ is known.

use crate::{Direction, Machine, Overrun, Part, RadialRange, Task, Tolerance, Tool};

/// A task as a recipe describes it, before the range of ρ is known.
#[derive(Debug, Clone)]
pub struct JobSpec {
    /// The part.
    pub part: Part,
    /// The tool.
    pub tool: Tool,
    /// The tolerances of the path.
    pub tolerance: Tolerance,
    /// How far the path runs beyond the part.
    pub overrun: Overrun,
    /// The direction of the feed.
    pub direction: Direction,
    /// The largest speed of the spindle, rad/s.
    pub spindle_speed: f64,
    /// The limits of the machine.
    pub machine: Machine,
}

impl JobSpec {
    /// The task over a range of ρ.
    pub fn over(self, range: RadialRange) -> Task {
        Task {
            part: self.part,
            tool: self.tool,
            tolerance: self.tolerance,
            range,
            direction: self.direction,
            spindle_speed: self.spindle_speed,
            machine: self.machine,
        }
    }
}
