//! Whether a nose of some radius fits a part.

use std::sync::Arc;

use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::largest_nose::{LargestNose, fits, largest_that_fits};
use turnpath_core::{
    Compensator, Cut, Overrun, Part, RadialRange, StrategyError, SurfaceModel, Tool, ToolLocus,
};

use crate::attributed::{NamedCompensator, NamedSurface};
use crate::contact::contact_range;
use crate::range::range;
use crate::{LocusLinks, PipelineError, Result};

/// The largest nose that is tried, in aperture radii. Beyond it the edge is straight for all that
/// it does to the part.
const STRAIGHT: f64 = 1e6;

/// What trials of noses have found.
struct KnownCurvature {
    /// The radii that the largest nose touches that is known to fit. Larger noses touch all of them, and so
    /// their trials need not look there again.
    range: RadialRange,
    /// The largest curvature there.
    largest: Extreme,
    /// The most curved place that the last refused nose touches.
    too_hollow: Option<Extreme>,
}

impl KnownCurvature {
    /// The known place in a region where a nose of this radius does not fit. A search of the region would find
    /// the same place or one like it, and is spared.
    fn place_that_refuses(&self, radius: f64, region: RadialRange) -> Option<Extreme> {
        let is_there = |place: &Extreme| (region.inner..=region.outer).contains(&place.rho);
        let too_hollow = self.too_hollow.filter(is_there);
        too_hollow.filter(|place| !fits(radius, place))
    }
}

/// A part, its surface and its compensator, on which noses of any radius are tried.
pub struct Fit<'a> {
    pub links: &'a LocusLinks,
    pub surface: Arc<dyn SurfaceModel>,
    pub compensator: Arc<dyn Compensator>,
    pub part: Part,
    pub tool: Tool,
    pub overrun: Overrun,
}

impl<'a> Fit<'a> {
    /// A surface and a compensator on a part.
    pub fn new(links: &'a LocusLinks, part: Part, tool: Tool, overrun: Overrun) -> Self {
        Self {
            links,
            surface: Arc::new(NamedSurface::new(&links.surface)),
            compensator: Arc::new(NamedCompensator::new(&links.compensator)),
            part,
            tool,
            overrun,
        }
    }

    /// The radii of the part without its overrun.
    pub fn whole_part(&self) -> RadialRange {
        RadialRange {
            inner: self.part.inner_radius,
            outer: self.part.aperture_radius,
        }
    }

    /// The largest nose that fits, where `on_part` is the largest curvature of the part itself.
    pub fn largest_nose(&self, on_part: Extreme) -> Result<LargestNose> {
        let most = STRAIGHT * self.part.aperture_radius;
        let mut known = KnownCurvature {
            range: self.whole_part(),
            largest: on_part,
            too_hollow: None,
        };
        largest_that_fits(on_part, most, |radius| {
            let tool = Tool {
                nose_radius: radius,
                ..self.tool
            };
            match self.largest_curvature(tool, &mut known) {
                // The surface ends within the reach of so large a nose, or there is no contact.
                Err(PipelineError::NoSurface(_) | PipelineError::BadAnswer { .. }) => Ok(Extreme {
                    value: f64::INFINITY,
                    ..on_part
                }),
                answer => answer,
            }
        })
    }

    /// The largest curvature where such a tool makes contact. What is known then covers its contacts, if
    /// the tool fits there.
    fn largest_curvature(&self, tool: Tool, known: &mut KnownCurvature) -> Result<Extreme> {
        let locus = ToolLocus::new(self.surface.clone(), self.compensator.clone(), tool);
        let region = contact_range(self.links, &locus, &tool, self.range(tool)?)?;
        if let Some(too_hollow) = known.place_that_refuses(tool.nose_radius, region) {
            return Ok(too_hollow);
        }
        let cut = Cut {
            surface: self.surface.as_ref(),
            tool: &tool,
        };
        let outside = self
            .compensator
            .curvature_outside(cut, known.range, region)
            .map_err(|error| self.failed_check(error))?;
        let largest = match outside {
            None => return Ok(self.interference(tool, region)?.curvature),
            // What is known covers the region.
            Some(nowhere) if nowhere.value == f64::NEG_INFINITY => known.largest,
            Some(outside) if !is_finite(&outside) => return Err(self.no_numbers(outside)),
            Some(outside) if outside.value > known.largest.value => outside,
            Some(_) => known.largest,
        };
        if !fits(tool.nose_radius, &largest) {
            known.too_hollow = Some(largest);
        } else if region.inner <= known.range.outer && known.range.inner <= region.outer {
            known.range = RadialRange {
                inner: known.range.inner.min(region.inner),
                outer: known.range.outer.max(region.outer),
            };
            known.largest = largest;
        }
        Ok(largest)
    }

    /// The range of ρ over which the path of such a tool runs.
    pub fn range(&self, tool: Tool) -> Result<RadialRange> {
        let (surface, compensator) = (self.surface.as_ref(), self.compensator.as_ref());
        range(self.overrun, &self.part, &tool, surface, compensator)
            .map_err(PipelineError::NoSurface)
    }

    /// What a region of the part requires of such a tool.
    pub fn interference(&self, tool: Tool, region: RadialRange) -> Result<Interference> {
        let cut = Cut {
            surface: self.surface.as_ref(),
            tool: &tool,
        };
        let answer = self.compensator.interference(cut, region);
        let interference = answer.map_err(|error| self.failed_check(error))?;
        if interference.extremes().iter().all(is_finite) {
            return Ok(interference);
        }
        Err(self.no_numbers(interference))
    }

    fn failed_check(&self, error: StrategyError) -> PipelineError {
        match error {
            StrategyError::Failed(_) => PipelineError::NoSurface(error),
            other => (self.links.compensator).failed("in the interference check", other),
        }
    }

    fn no_numbers(&self, found: impl std::fmt::Debug) -> PipelineError {
        let what = format!("no numbers in its interference check: {found:?}");
        self.links.compensator.bad_answer(what)
    }
}

fn is_finite(extreme: &Extreme) -> bool {
    let all = [extreme.value, extreme.theta, extreme.rho];
    all.iter().all(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nose_is_refused_where_it_touches_a_place_that_is_known_to_be_too_hollow() {
        let place = |value, rho| Extreme {
            value,
            theta: 1.0,
            rho,
        };
        let to = |outer| RadialRange { inner: 0.0, outer };
        let known = KnownCurvature {
            range: to(4.0),
            largest: place(0.1, 3.0),
            too_hollow: Some(place(0.5, 9.0)),
        };
        assert_eq!(
            known.place_that_refuses(2.1, to(10.0)),
            Some(place(0.5, 9.0))
        );
        // It fits there, or it does not reach the place.
        assert_eq!(known.place_that_refuses(1.9, to(10.0)), None);
        assert_eq!(known.place_that_refuses(2.1, to(8.0)), None);
    }
}
