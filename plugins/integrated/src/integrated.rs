//! The sampler `integrated`.

use turnpath_plugin::prelude::*;

use crate::arc::{ArcSteps, SMALLEST_STEP, SPACING};

/// Equal arcs outside. Further in, where these arcs would span more than the largest angle, equal
/// angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Integrated {
    steps: ArcSteps,
}

const MAX_STEP: Param<Angle> = Param::angle(
    "max_step",
    "largest angle step, which binds near the centre",
)
.default(45.0 * DEG)
.min(SMALLEST_STEP)
.max(90.0 * DEG);

impl Strategy for Integrated {
    const NAME: &'static str = "integrated";
    const SUMMARY: &'static str = "equal arcs outside, and equal angles from where those would be \
        larger than max_step on inwards";
    const SOURCE: &'static str = "the integrated discretization paper, doi:10.1177/0954405416654192: the smaller of its two \
        steps everywhere";
    const PARAMS: &'static [ParamInfo] = &[SPACING.info(), MAX_STEP.info()];

    fn new(params: &Params) -> Result<Self> {
        let steps = ArcSteps::new(params, params.get(MAX_STEP));
        Ok(Self { steps })
    }
}

impl Sampler for Integrated {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(self.steps))
    }
}
