//! No compensation: the path of a point.

use turnpath_plugin::prelude::*;

use crate::polar::{Evaluation, Rays, TurningRay, batches};

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
        let (mut points, mut rays) = (Evaluation::default(), Rays::default());
        for batch in batches(theta.len()) {
            let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
            let rays = rays.at(theta.iter().copied());
            points.set(rays.zip(rho).map(|(ray, rho)| ray.point(*rho)));
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
        let (mut curves, mut rays) = ((Vec::new(), Vec::new()), Rays::default());
        let rays = rays.at(theta.iter().map(|theta| theta[0]));
        for ((ray, theta), rho) in rays.zip(theta).zip(rho) {
            let (x, y) = TurningRay::from(ray, Taylor(*theta)).point(Taylor(*rho));
            curves.0.push(x.0);
            curves.1.push(y.0);
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

    fn curvature_outside(
        &self,
        cut: Cut<'_>,
        part: RadialRange,
        region: RadialRange,
    ) -> Result<Option<interference::Extreme>> {
        interference::curvature_outside(cut, part, region).map(Some)
    }
}

fn rates(cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
    let (mut points, mut rays) = (Evaluation::default(), Rays::default());
    for batch in batches(theta.len()) {
        let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
        let rays = rays.at(theta.iter().copied());
        points.set(rays.clone().zip(rho).map(|(ray, rho)| ray.point(*rho)));
        points.gradient(cut.surface)?;
        for ((i, at), ray) in batch.enumerate().zip(rays) {
            let (zx, zy) = (points.zx[i], points.zy[i]);
            out.z_theta[at] = rho[i] * ray.across(zx, zy);
            out.z_x[at] = ray.along(zx, zy);
        }
    }
    out.x_theta.fill(0.0);
    out.x_rho.fill(1.0);
    Ok(())
}
