//! The compensator: from a point of the part to the position of the tool's nose centre.

use crate::interference::{self, Extreme, Interference};
use crate::{Cut, Radial, RadialRange, Result, Series};

/// Where [`Compensator::centre`] writes. Each slice has one element for each point.
#[derive(Debug)]
pub struct Centres<'a> {
    /// X of the nose centre, mm.
    pub x: &'a mut [f64],
    /// Z of the nose centre, mm.
    pub z: &'a mut [f64],
    /// Radius of the contact, mm; negative beyond the spindle axis.
    pub foot: &'a mut [f64],
}

/// Where [`Compensator::exact_series`] writes the nose centre along each curve.
#[derive(Debug)]
pub struct CentreSeries<'a> {
    /// X(t).
    pub x: &'a mut [Series],
    /// Z(t).
    pub z: &'a mut [Series],
}

/// Where [`Compensator::exact_rates`] writes how the nose centre moves.
#[derive(Debug)]
pub struct Rates<'a> {
    /// ∂X/∂θ at constant ρ, mm/rad.
    pub x_theta: &'a mut [f64],
    /// ∂X/∂ρ at constant θ.
    pub x_rho: &'a mut [f64],
    /// ∂Z/∂θ at constant X, mm/rad.
    pub z_theta: &'a mut [f64],
    /// ∂Z/∂X at constant θ.
    pub z_x: &'a mut [f64],
}

/// Places the nose centre for a C angle θ and a radial parameter ρ.
///
/// A compensator must implement [`centre`](Compensator::centre) alone. The host fits numerically
/// what a compensator does not give exactly (see [`fit`](crate::fit)). All slices of one call have
/// the same length.
pub trait Compensator: Send + Sync {
    /// What ρ means.
    fn radial(&self) -> Radial;

    /// Whether the compensator compensates the nose radius. If it does not, the path is that of a
    /// point.
    fn compensates_nose(&self) -> bool {
        true
    }

    /// Whether the nose stops where any part of its edge first touches the surface, so that a nose
    /// that does not fit cuts into nothing. If this is false, the host refuses a task with
    /// [`Misfit::CutWhatFits`](crate::Misfit) on a part into which the nose does not fit.
    fn cuts_what_fits(&self) -> bool {
        false
    }

    /// The nose centre and the contact for each (θ, ρ). NaN marks a point that has none.
    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()>;

    /// The exact order-4 series of the nose centre along the curves (θ(t), ρ(t)); `None` if the
    /// compensator has no exact series.
    fn exact_series(
        &self,
        cut: Cut<'_>,
        theta: &[Series],
        rho: &[Series],
        out: CentreSeries<'_>,
    ) -> Option<Result<()>> {
        let _ = (cut, theta, rho, out);
        None
    }

    /// The exact partial rates of the nose centre; `None` if the compensator has no exact rates.
    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        let _ = (cut, theta, rho, out);
        None
    }

    /// The nose centre and its exact partial rates at once, from one search for each contact: the
    /// numbers of [`centre`](Compensator::centre) and [`exact_rates`](Compensator::exact_rates).
    /// `None` if the compensator has no exact rates, or if it would search for each of both.
    fn centre_and_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        centres: Centres<'_>,
        rates: Rates<'_>,
    ) -> Option<Result<()>> {
        let _ = (cut, theta, rho, centres, rates);
        None
    }

    /// Looks for points within `region` (radii of the contact) that the tool cannot cut.
    fn interference(&self, cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
        interference::check(cut, region)
    }

    /// The largest curvature that [`interference`](Compensator::interference) finds within `region`,
    /// where it is not within `known`: that of
    /// [`curvature_outside`](interference::curvature_outside). `None` from a compensator that looks at
    /// whole regions alone. The search for the largest nose that fits asks for it once a trial. `known`
    /// is then all that smaller noses have touched, and a place that it finds for one nose counts for smaller
    /// ones that touch it too. So the curvature must not depend on the tool.
    fn curvature_outside(
        &self,
        cut: Cut<'_>,
        known: RadialRange,
        region: RadialRange,
    ) -> Result<Option<Extreme>> {
        let _ = (cut, known, region);
        Ok(None)
    }
}
