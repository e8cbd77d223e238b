//! Strategies that others call, with their names in their errors.
//!
//! A sampler that fails because the surface panicked is not to blame. The surface's error crosses
//! it as [`StrategyError::Delegate`], and the message names the surface.

use std::sync::Arc;

use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::{
    CentreSeries, Centres, Compensator, Cut, GradientSeries, Gradients, Radial, RadialRange, Rates,
    Result, Series, SeriesOrders, Slot, StrategyError, SurfaceData, SurfaceGap, SurfaceModel,
};

use crate::Link;

/// The strategy that answers.
#[derive(Debug, Clone)]
struct StrategyName {
    slot: Slot,
    /// The number of a surface in a sum, else 0.
    entry: usize,
    text: String,
}

impl StrategyName {
    fn of<T: ?Sized>(link: &Link<T>, entry: usize) -> Self {
        let text = format!(
            "the {} `{}` of {}",
            link.slot.noun(),
            link.name,
            link.plugin
        );
        Self {
            slot: link.slot,
            entry,
            text,
        }
    }

    /// Puts the name into the error, unless the error names another strategy already.
    fn attribute<T>(&self, answer: Result<T>) -> Result<T> {
        answer.map_err(|error| match error {
            inner @ StrategyError::Delegate { .. } => inner,
            own => StrategyError::Delegate {
                slot: self.slot,
                entry: self.entry,
                message: format!("{}: {own}", self.text).into(),
            },
        })
    }
}

/// A surface whose errors carry its name.
pub struct NamedSurface {
    name: StrategyName,
    surface: Arc<dyn SurfaceModel>,
}

impl NamedSurface {
    /// The surface of a chain.
    pub fn new(link: &Link<dyn SurfaceModel>) -> Self {
        Self::of_sum(link, 0)
    }

    /// The surface of that number in a sum, counted from 0.
    pub fn of_sum(link: &Link<dyn SurfaceModel>, entry: usize) -> Self {
        Self {
            name: StrategyName::of(link, entry),
            surface: link.strategy.clone(),
        }
    }
}

impl SurfaceModel for NamedSurface {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        self.name.attribute(self.surface.heights(x, y, z))
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        self.name.attribute(self.surface.gradient(x, y, out))
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        self.name.attribute(self.surface.series(x, y, out))
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        self.name.attribute(self.surface.height_series(x, y, z))
    }

    fn series_to(
        &self,
        orders: SeriesOrders,
        x: &[Series],
        y: &[Series],
        out: GradientSeries<'_>,
    ) -> Result<()> {
        self.name
            .attribute(self.surface.series_to(orders, x, y, out))
    }

    fn height_series_to(
        &self,
        order: usize,
        x: &[Series],
        y: &[Series],
        z: &mut [Series],
    ) -> Result<()> {
        self.name
            .attribute(self.surface.height_series_to(order, x, y, z))
    }

    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        self.name
            .attribute(self.surface.beyond_data(x, y, distance))
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        self.name.attribute(self.surface.data())
    }

    fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> {
        let gap = self.name.attribute(self.surface.gap(x, y))?;
        let entry = self.name.entry;
        Ok(gap.map(|gap| SurfaceGap { entry, ..gap }))
    }
}

/// A compensator whose errors carry its name.
pub struct NamedCompensator {
    name: StrategyName,
    compensator: Arc<dyn Compensator>,
}

impl NamedCompensator {
    /// The compensator of a chain.
    pub fn new(link: &Link<dyn Compensator>) -> Self {
        Self {
            name: StrategyName::of(link, 0),
            compensator: link.strategy.clone(),
        }
    }

    /// Puts the name into the error of a check, unless the check itself refuses the surface: that is the
    /// recipe's fault, not a plugin's.
    fn attribute_check<T>(&self, answer: Result<T>) -> Result<T> {
        match answer {
            Err(StrategyError::Failed(reason)) => Err(StrategyError::Failed(reason)),
            answer => self.name.attribute(answer),
        }
    }
}

impl Compensator for NamedCompensator {
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
        self.name
            .attribute(self.compensator.centre(cut, theta, rho, out))
    }

    fn exact_series(
        &self,
        cut: Cut<'_>,
        theta: &[Series],
        rho: &[Series],
        out: CentreSeries<'_>,
    ) -> Option<Result<()>> {
        let answer = self.compensator.exact_series(cut, theta, rho, out)?;
        Some(self.name.attribute(answer))
    }

    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        let answer = self.compensator.exact_rates(cut, theta, rho, out)?;
        Some(self.name.attribute(answer))
    }

    fn centre_and_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        centres: Centres<'_>,
        rates: Rates<'_>,
    ) -> Option<Result<()>> {
        let compensator = &self.compensator;
        let answer = compensator.centre_and_rates(cut, theta, rho, centres, rates)?;
        Some(self.name.attribute(answer))
    }

    fn interference(&self, cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
        self.attribute_check(self.compensator.interference(cut, region))
    }

    fn curvature_outside(
        &self,
        cut: Cut<'_>,
        part: RadialRange,
        region: RadialRange,
    ) -> Result<Option<Extreme>> {
        self.attribute_check(self.compensator.curvature_outside(cut, part, region))
    }
}
