//! Whether a nose fits a job's part, and the largest that does, overrun included.

use std::sync::Arc;

use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::largest_nose::{LargestNose, largest_that_fits};
use turnpath_core::{
    Compensator, Cut, Overrun, Part, RadialRange, StrategyError, SurfaceModel, Tool, ToolLocus,
};

use crate::attributed::{AttributedCompensator, AttributedSurface};
use crate::prepare::contact_range;
use crate::range::range;
use crate::{Chain, PipelineError, Prepared, Result};

/// Beyond this many aperture radii the edge is straight for all that it does to the part.
const STRAIGHT: f64 = 1e6;

/// The largest nose for the chain and job, with what limits it.
///
/// # Errors
/// When a strategy fails.
pub fn largest_nose(chain: &Chain, prepared: &Prepared) -> Result<LargestNose> {
    let task = &prepared.task;
    let fit = Fit::new(chain, task.part, task.tool, prepared.overrun);
    let on_part = fit.interference(task.tool, fit.whole_part())?;
    fit.largest_nose(on_part.curvature)
}

/// What a nose of any size is tried on.
pub(crate) struct Fit<'a> {
    pub chain: &'a Chain,
    pub surface: Arc<dyn SurfaceModel>,
    pub compensator: Arc<dyn Compensator>,
    pub part: Part,
    pub tool: Tool,
    pub overrun: Overrun,
}

impl<'a> Fit<'a> {
    /// The chain's surface and compensator on a part.
    pub fn new(chain: &'a Chain, part: Part, tool: Tool, overrun: Overrun) -> Self {
        Self {
            chain,
            surface: Arc::new(AttributedSurface::new(&chain.surface)),
            compensator: Arc::new(AttributedCompensator::new(&chain.compensator)),
            part,
            tool,
            overrun,
        }
    }

    /// The radii of the part, its overrun aside.
    pub fn whole_part(&self) -> RadialRange {
        RadialRange {
            inner: self.part.inner_radius,
            outer: self.part.aperture_radius,
        }
    }

    /// The largest nose, where `on_part` is the largest curvature of the part itself.
    pub fn largest_nose(&self, on_part: Extreme) -> Result<LargestNose> {
        let most = STRAIGHT * self.part.aperture_radius;
        largest_that_fits(on_part, most, |radius| {
            let tool = Tool {
                nose_radius: radius,
                ..self.tool
            };
            match self.reached(tool) {
                // The surface ends within the reach of so large a nose, or no contact is found.
                Err(PipelineError::NoSurface(_) | PipelineError::BadAnswer { .. }) => Ok(Extreme {
                    value: f64::INFINITY,
                    ..on_part
                }),
                answer => answer,
            }
        })
    }

    /// The largest curvature where such a tool makes contact.
    fn reached(&self, tool: Tool) -> Result<Extreme> {
        let locus = ToolLocus::new(self.surface.clone(), self.compensator.clone(), tool);
        let region = contact_range(self.chain, &locus, &tool, self.range(tool)?)?;
        Ok(self.interference(tool, region)?.curvature)
    }

    /// The range of ρ over which such a tool runs.
    pub fn range(&self, tool: Tool) -> Result<RadialRange> {
        let (surface, compensator) = (self.surface.as_ref(), self.compensator.as_ref());
        range(self.overrun, &self.part, &tool, surface, compensator)
            .map_err(PipelineError::NoSurface)
    }

    /// What a region of the part asks of such a tool.
    pub fn interference(&self, tool: Tool, region: RadialRange) -> Result<Interference> {
        let cut = Cut {
            surface: self.surface.as_ref(),
            tool: &tool,
        };
        let answer = self.compensator.interference(cut, region);
        let link = &self.chain.compensator;
        let found = answer.map_err(|error| match error {
            StrategyError::Failed(_) => PipelineError::NoSurface(error),
            other => link.failed("in the interference check", other),
        })?;
        let numbers = |extreme: &Extreme| {
            let all = [extreme.value, extreme.theta, extreme.rho];
            all.iter().all(|number| number.is_finite())
        };
        if found.extremes().iter().all(numbers) {
            return Ok(found);
        }
        let what = format!("no numbers in its interference check: {found:?}");
        Err(link.bad_answer(what))
    }
}
