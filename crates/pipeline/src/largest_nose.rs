//! The largest nose that a job's part admits, overrun included.

use std::sync::Arc;

use turnpath_core::extreme::Extreme;
use turnpath_core::largest_nose::{LargestNose, largest_that_fits};
use turnpath_core::{Compensator, Cut, Overrun, Part, RadialRange, SurfaceModel, Tool, ToolLocus};

use crate::attributed::{AttributedCompensator, AttributedSurface};
use crate::prepare::{contact_range, interference};
use crate::range::range;
use crate::{Chain, PipelineError, Prepared, Result};

/// Beyond this many aperture radii the edge is straight for all that it does to the part.
const STRAIGHT: f64 = 1e6;

/// The largest nose for the chain and job, with what limits it.
///
/// # Errors
/// When a strategy fails.
pub fn largest_nose(chain: &Chain, prepared: &Prepared) -> Result<LargestNose> {
    let job = &prepared.job;
    let fit = Fit {
        chain,
        surface: Arc::new(AttributedSurface::new(&chain.surface)),
        compensator: Arc::new(AttributedCompensator::new(&chain.compensator)),
        part: job.part,
        tool: job.tool,
        overrun: prepared.overrun,
    };
    let on_part = fit.curvature(job.tool, fit.whole_part())?;
    fit.largest_nose(on_part)
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

impl Fit<'_> {
    fn whole_part(&self) -> RadialRange {
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
        let range = range(
            self.overrun,
            &self.part,
            &tool,
            self.surface.as_ref(),
            self.compensator.as_ref(),
        )
        .map_err(PipelineError::NoSurface)?;
        let region = contact_range(self.chain, &locus, &tool, range)?;
        self.curvature(tool, region)
    }

    fn curvature(&self, tool: Tool, region: RadialRange) -> Result<Extreme> {
        let cut = Cut {
            surface: self.surface.as_ref(),
            tool: &tool,
        };
        let compensator = self.compensator.as_ref();
        Ok(interference(self.chain, compensator, cut, region)?.curvature)
    }
}
