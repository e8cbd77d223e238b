//! No compensation: the path of a point.

use turnpath_plugin::prelude::*;

use crate::polar::{Evaluation, Ray, TurningRay, batches};

/// X = ρ, Z = g(θ, ρ): the path of the contact, whatever the nose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uncompensated;

impl Strategy for Uncompensated {
    const NAME: &'static str = "none";
    const SUMMARY: &'static str = "no compensation: the nose radius taken as 0";
    const SOURCE: &'static str = "X = ρ, Z = g(θ, ρ)";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl Compensator for Uncompensated {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn compensates_nose(&self) -> bool {
        false
    }

    /// A point fits anywhere.
    fn cuts_what_fits(&self) -> bool {
        true
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let mut points = Evaluation::default();
        for batch in batches(theta.len()) {
            let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
            points.set(theta.iter().zip(rho).map(|(t, r)| Ray::at(*t).point(*r)));
            points.gradient(cut.surface)?;
            out.z[batch].copy_from_slice(&points.z);
        }
        out.x.copy_from_slice(rho);
        out.foot.copy_from_slice(rho);
        Ok(())
    }

    fn exact_series(
        &self,
        cut: Cut<'_>,
        theta: &[Series],
        rho: &[Series],
        out: CentreSeries<'_>,
    ) -> Option<Result<()>> {
        let mut curves = (Vec::new(), Vec::new());
        for (theta, rho) in theta.iter().zip(rho) {
            let (x, y) = TurningRay::at(*theta).point(Taylor(*rho));
            curves.0.push(x);
            curves.1.push(y);
        }
        out.x.copy_from_slice(rho);
        Some(cut.surface.height_series(&curves.0, &curves.1, out.z))
    }

    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        Some(rates(cut, theta, rho, out))
    }
}

fn rates(cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
    let mut points = Evaluation::default();
    for batch in batches(theta.len()) {
        let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
        points.set(theta.iter().zip(rho).map(|(t, r)| Ray::at(*t).point(*r)));
        points.gradient(cut.surface)?;
        for (i, at) in batch.enumerate() {
            let (ray, zx, zy) = (Ray::at(theta[i]), points.zx[i], points.zy[i]);
            out.z_theta[at] = rho[i] * ray.across(zx, zy);
            out.z_x[at] = ray.along(zx, zy);
        }
    }
    out.x_theta.fill(0.0);
    out.x_rho.fill(1.0);
    Ok(())
}
