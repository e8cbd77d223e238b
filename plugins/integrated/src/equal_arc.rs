//! The sampler `equal-arc`.

use turnpath_plugin::prelude::*;

use crate::arc::{ArcSteps, SPACING};

/// Largest angle of a step. Near the centre the arc of one turn is shorter than any spacing.
const LARGEST_STEP: f64 = 90.0 * DEG;

/// Neighbouring nodes lie one arc length apart along the spiral, seen from above.
#[derive(Debug, Clone, PartialEq)]
pub struct EqualArc {
    steps: ArcSteps,
}

impl Strategy for EqualArc {
    const NAME: &'static str = "equal-arc";
    const SUMMARY: &'static str = "equal arcs along the spiral, at most 90 deg apart";
    const SOURCE: &'static str = "the equal arc length discretization of the integrated \
        discretization paper: worst near the centre";
    const PARAMS: &'static [ParamInfo] = &[SPACING.info()];

    fn new(params: &Params) -> Result<Self> {
        let steps = ArcSteps::new(params, LARGEST_STEP);
        Ok(Self { steps })
    }
}

impl Sampler for EqualArc {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(self.steps))
    }
}
