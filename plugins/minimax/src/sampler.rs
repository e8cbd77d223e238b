//! The sampler `minimax`.

use turnpath_plugin::hermite::{FEED_PART, MAX_STEP, WANDER};
use turnpath_plugin::prelude::*;

use crate::grid::Grid;
use crate::natural_steps::NaturalSteps;
use crate::reach::{Precision, Reach};
use crate::search::Search;
use crate::spans::spans;
use crate::state::{State, states};
use crate::table::{Limits, Table};
use crate::wandering::Wandering;

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
    states: &'static [State],
    /// In rad.
    max_step: f64,
    wander: bool,
}

/// The best chain of steps of every block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Chains {
    states: &'static [State],
    wandering: Wandering,
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
        Ok(Self {
            states,
            max_step: params.get(MAX_STEP),
            wander: params.get(WANDER),
        })
    }
}

impl Sampler for MinimaxSampler {
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        let wandering = Wandering::new(path, self.max_step, self.wander, allowed(path))?;
        Ok(Box::new(Chains {
            states: self.states,
            wandering,
        }))
    }

    fn needs_exact_rates(&self) -> bool {
        true
    }
}

impl SamplerPlan for Chains {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let limits = Limits {
            allowed: allowed(path),
            feed_part: FEED_PART,
            max_step: self.wandering.shorter(),
        };
        for span in spans(path, block, limits)? {
            self.place_span(path, span, limits, nodes)?;
        }
        Ok(())
    }
}

/// The largest error of Z of a step, mm.
fn allowed(path: &Path<'_>) -> f64 {
    LARGEST_OFFSET * path.task.tolerance.interpolation
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
        let mut table = Table::new(path, &samples, limits)?;
        let natural = NaturalSteps::new(&samples, &table);
        table.limits.max_step = self.wandering.step(natural.largest_fourth);
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
