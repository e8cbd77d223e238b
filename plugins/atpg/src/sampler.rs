//! The sampler `atpg`.

use turnpath_plugin::hermite::{self, FEED_PART, MAX_STEP, Steps};
use turnpath_plugin::prelude::*;

/// The part of the feed that X's own interpolation error may take where X does not move within the
/// turn. It costs nothing there, and the cusp grows by 4e-4 of itself at the most.
const STILL_PART: f64 = 1e-4;

/// Off by default: the paper's steps do not wander.
const WANDER: Param<Flag> = hermite::WANDER.default(false);

/// Steps as long as eq. 10 allows, ε ≥ L⁴/384 max|φ⁗| over the step, along the played path.
#[derive(Debug, Clone, PartialEq)]
pub struct AtpgSampler {
    steps: Steps,
}

impl Strategy for AtpgSampler {
    const NAME: &'static str = "atpg";
    const SUMMARY: &'static str = "steps as long as the interpolation tolerance allows, from the \
        4th derivative of the tool centre's own path";
    const SOURCE: &'static str = "Wang et al. 2019, Materials 12, 810, \
        doi:10.3390/ma12050810, §3.4, eq. 10; on the compensated path, and with the step's own maximum";
    const PARAMS: &'static [ParamInfo] = &[MAX_STEP.info(), WANDER.info()];

    fn new(params: &Params) -> Result<Self> {
        let max_step = hermite::largest_step(params.get(MAX_STEP), params.get(WANDER));
        let steps = Steps {
            max_step,
            feed_part: STILL_PART,
        };
        Ok(Self { steps })
    }
}

impl Sampler for AtpgSampler {
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        let feed_part = match hermite::x_swings(path)? {
            true => FEED_PART,
            false => STILL_PART,
        };
        Ok(Box::new(Steps {
            feed_part,
            ..self.steps
        }))
    }
}
