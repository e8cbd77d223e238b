//! The sampler `ats`.

use turnpath_plugin::hermite::{MAX_STEP, Steps};
use turnpath_plugin::prelude::*;

/// The part of the distance between passes that X's own interpolation error may take. X moves all
/// the time here, and it is often X that decides: with a fifth of this part, ATPG's, steps would be
/// shorter by half again. The feed's margin has room for two passes that err in opposite directions
/// by this part.
const FEED_PART: f64 = 5e-4;

/// Steps as long as the error of a cubic segment allows on a path whose X moves too.
#[derive(Debug, Clone, PartialEq)]
pub struct AtsSampler {
    steps: Steps,
}

impl Strategy for AtsSampler {
    const NAME: &'static str = "ats";
    const SUMMARY: &'static str = "steps as long as the interpolation tolerance allows on a path \
        whose X moves within the turn";
    const SOURCE: &'static str = "after Zhu and To 2015, doi:10.1364/OE.23.020234, whose angle follows the shape at every \
        point; the bound is Wang et al. 2019, eq. 10, for Z and X together";
    const PARAMS: &'static [ParamInfo] = &[MAX_STEP.info()];

    fn new(params: &Params) -> Result<Self> {
        let steps = Steps::new(params, FEED_PART);
        Ok(Self { steps })
    }
}

impl Sampler for AtsSampler {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(self.steps))
    }
}
