//! Triangle rotary: velocities that make C, X and Z twice continuously differentiable.

use turnpath_plugin::prelude::*;

use crate::spline::{End, System};

/// Number of nodes that a block needs on either side. The influence of an end falls to less than
/// half from node to node, so what lies beyond 64 nodes has 2⁻⁶⁴ of it, far below rounding.
const OVERLAP: usize = 64;

/// The slopes of the C² cubic spline through the nodes of each axis.
///
/// The error of position is of order 4 in the step, for any steps. With natural ends it is of order
/// 2 near the path's two ends, where the true acceleration is not 0. `ends` applies to the two ends
/// of the path; a window of the path is clamped to the exact rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TriangleRotary {
    ends: Ends,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ends {
    Clamped,
    Natural,
    NotAKnot,
}

const ENDS: Param<Choice> = Param::choice(
    "ends",
    &["clamped", "natural", "not-a-knot"],
    "at the path's two ends: the exact rates, no acceleration, or no jump of jerk at the next node",
)
.default("clamped");

impl Strategy for TriangleRotary {
    const NAME: &'static str = "triangle-rotary";
    const SUMMARY: &'static str = "the C² cubic spline: no jumps of acceleration within the path";
    const SOURCE: &'static str = "the paper on triangle rotary, doi:10.1177/0954405416654192; cubic spline in slope form, λ m₋ + 2m + μ m₊ = 3(λ d₋ + μ d), \
        solved by forward sweep and back substitution";
    const PARAMS: &'static [ParamInfo] = &[ENDS.info()];

    fn new(params: &Params) -> Result<Self> {
        let ends = match params.get(ENDS) {
            "natural" => Ends::Natural,
            "not-a-knot" => Ends::NotAKnot,
            _ => Ends::Clamped,
        };
        Ok(Self { ends })
    }
}

impl TriangleRotary {
    fn end(&self, of_path: bool) -> End {
        match self.ends {
            Ends::Natural if of_path => End::Natural,
            Ends::NotAKnot if of_path => End::NotAKnot,
            _ => End::Clamped,
        }
    }
}

impl VelocitySolver for TriangleRotary {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(OVERLAP)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let ends = [self.end(nodes.at_start), self.end(nodes.at_end)];
        let system = System::factor(nodes.t, ends);
        system.solve(nodes.c, |k| nodes.c_rate[k], out.c);
        system.solve(nodes.x, |k| nodes.x_rate[k], out.x);
        system.solve(nodes.z, |k| nodes.z_rate(k), out.z);
        Ok(())
    }
}
