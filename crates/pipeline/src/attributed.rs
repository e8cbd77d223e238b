//! Strategies that others ask, with their names put into what they say.
//!
//! A sampler that fails because the surface panicked is not to blame: the surface's error crosses
//! it as [`StrategyError::Delegate`], and the message names the surface.

use std::sync::Arc;

use turnpath_core::interference::Interference;
use turnpath_core::{
    CentreSeries, Centres, Compensator, Cut, GradientSeries, Gradients, Radial, RadialRange, Rates,
    Result, Series, Slot, StrategyError, SurfaceModel,
};

use crate::Link;

/// Who answers.
#[derive(Debug, Clone)]
struct Name {
    slot: Slot,
    text: String,
}

impl Name {
    fn of<T: ?Sized>(link: &Link<T>) -> Self {
        let text = format!(
            "the {} `{}` of {}",
            link.slot.noun(),
            link.name,
            link.plugin
        );
        Self {
            slot: link.slot,
            text,
        }
    }

    fn put<T>(&self, answer: Result<T>) -> Result<T> {
        answer.map_err(|error| match error {
            asked @ StrategyError::Delegate { .. } => asked,
            own => StrategyError::Delegate {
                slot: self.slot,
                message: format!("{}: {own}", self.text).into(),
            },
        })
    }
}

/// A surface whose errors say whose they are.
pub struct AttributedSurface {
    name: Name,
    surface: Arc<dyn SurfaceModel>,
}

impl AttributedSurface {
    /// The surface of a chain.
    pub fn new(link: &Link<dyn SurfaceModel>) -> Self {
        Self {
            name: Name::of(link),
            surface: link.strategy.clone(),
        }
    }
}

impl SurfaceModel for AttributedSurface {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        self.name.put(self.surface.heights(x, y, z))
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        self.name.put(self.surface.gradient(x, y, out))
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        self.name.put(self.surface.series(x, y, out))
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        self.name.put(self.surface.height_series(x, y, z))
    }
}

/// A compensator whose errors say whose they are.
pub struct AttributedCompensator {
    name: Name,
    compensator: Arc<dyn Compensator>,
}

impl AttributedCompensator {
    /// The compensator of a chain.
    pub fn new(link: &Link<dyn Compensator>) -> Self {
        Self {
            name: Name::of(link),
            compensator: link.strategy.clone(),
        }
    }
}

impl Compensator for AttributedCompensator {
    fn radial(&self) -> Radial {
        self.compensator.radial()
    }

    fn compensates_nose(&self) -> bool {
        self.compensator.compensates_nose()
    }

    fn cuts_what_fits(&self) -> bool {
        self.compensator.cuts_what_fits()
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        self.name.put(self.compensator.centre(cut, theta, rho, out))
    }

    fn exact_series(
        &self,
        cut: Cut<'_>,
        theta: &[Series],
        rho: &[Series],
        out: CentreSeries<'_>,
    ) -> Option<Result<()>> {
        let answer = self.compensator.exact_series(cut, theta, rho, out)?;
        Some(self.name.put(answer))
    }

    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        let answer = self.compensator.exact_rates(cut, theta, rho, out)?;
        Some(self.name.put(answer))
    }

    fn interference(&self, cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
        match self.compensator.interference(cut, region) {
            // What the check itself says of the surface is about the recipe, not about a plugin.
            Err(StrategyError::Failed(said)) => Err(StrategyError::Failed(said)),
            answer => self.name.put(answer),
        }
    }
}
