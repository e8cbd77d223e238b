//! The sampler `minimax`.

use turnpath_plugin::hermite::{FEED_PART, MAX_STEP, WANDER, largest_step};
use turnpath_plugin::prelude::*;

use crate::grid::Grid;
use crate::natural_steps::NaturalSteps;
use crate::reach::{Precision, Reach};
use crate::search::Search;
use crate::spans::spans;
use crate::state::{State, states};
use crate::table::{Limits, Table};

/// How closely steps are found where all nodes lie on the locus.
const ON_LOCUS: Precision = Precision {
    growth: 1.04,
    halvings: 12,
};
/// How closely steps are found among several states. What a step misses is made up by the next one.
const AMONG_STATES: Precision = Precision {
    growth: 1.1,
    halvings: 6,
};

const STATES: Param<Count> = Param::count(
    "states",
    "how many states a node may have: 1 keeps all nodes on the path; 3, 7 or 25 place them up to \
             the tolerance beside it",
)
.default(7)
.min(1)
.max(25);

/// Steps that are as long as the tolerance allows as played, with nodes beside the path.
#[derive(Debug, Clone, PartialEq)]
pub struct MinimaxSampler {
    plan: Chains,
}

/// The best chain of steps of every block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Chains {
    states: &'static [State],
    max_step: f64,
}

impl Strategy for MinimaxSampler {
    const NAME: &'static str = "minimax";
    const SUMMARY: &'static str = "the fewest points: cubics that use the interpolation tolerance \
        on both sides, as played";
    const SOURCE: &'static str = "beyond the papers: the best uniform approximation by cubics that \
        join with their rates, found as a shortest path";
    const PARAMS: &'static [ParamInfo] = &[STATES.info(), MAX_STEP.info(), WANDER.info()];

    fn new(params: &Params) -> Result<Self> {
        let count = params.get(STATES);
        let states = states(count)
            .ok_or_else(|| STATES.refused(format!("{count} is none of 1, 3, 7 and 25")))?;
        let (max_step, wander) = (params.get(MAX_STEP), params.get(WANDER));
        let plan = Chains {
            states,
            max_step: largest_step(max_step, wander),
        };
        Ok(Self { plan })
    }
}

impl Sampler for MinimaxSampler {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(self.plan))
    }

    fn needs_exact_rates(&self) -> bool {
        true
    }
}

impl SamplerPlan for Chains {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let limits = Limits {
            allowed: LARGEST_OFFSET * path.task.tolerance.interpolation,
            feed_part: FEED_PART,
            max_step: self.max_step / TAU,
        };
        for span in spans(path, block, limits)? {
            self.place_span(path, span, limits, nodes)?;
        }
        Ok(())
    }
}

impl Chains {
    fn place_span(
        &self,
        path: &Path<'_>,
        span: Revolutions,
        limits: Limits,
        nodes: &mut NodeList,
    ) -> Result<()> {
        let samples = Grid::new(path, span, limits.allowed)?.into_samples()?;
        let table = Table::new(path, &samples, limits)?;
        let natural = NaturalSteps::new(&samples, &table);
        drop(samples);
        let reach = Reach {
            table: &table,
            natural: &natural,
            precision: match self.states.len() {
                1 => ON_LOCUS,
                _ => AMONG_STATES,
            },
        };
        Search::new(&reach, self.states, path.task.tool.misfit).run(nodes)
    }
}
