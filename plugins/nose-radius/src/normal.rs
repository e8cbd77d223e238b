//! Compensation along the normal of the radial section.

use turnpath_plugin::prelude::*;

use crate::polar::{Evaluation, Rays, TurningRay, batches};

/// X = ρ − R g_ρ/w, Z = g + R/w: the nose touches the radial section at ρ.
///
/// X follows the slope, so it moves back and forth within a revolution. Near the centre of a tilted
/// part X is negative, and the tool crosses the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Normal;

impl Strategy for Normal {
    const NAME: &'static str = "normal";
    const SUMMARY: &'static str =
        "the nose centre off the contact along the radial section's normal; X follows the slope";
    const SOURCE: &'static str = "X = ρ − R g_ρ/w, Z = g + R/w with w = sqrt(1 + g_ρ²)";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl Compensator for Normal {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let radius = cut.tool.nose_radius;
        let (mut points, mut rays) = (Evaluation::default(), Rays::default());
        for batch in batches(theta.len()) {
            let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
            let rays = rays.at(theta.iter().copied());
            points.set(rays.clone().zip(rho).map(|(ray, rho)| ray.point(*rho)));
            points.gradient(cut.surface)?;
            for ((i, at), ray) in batch.enumerate().zip(rays) {
                let slope = ray.along(points.zx[i], points.zy[i]);
                (out.x[at], out.z[at]) = centre(radius, rho[i], points.z[i], slope);
            }
        }
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
        Some(series(cut, theta, rho, out))
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

/// X and Z of the nose centre from the contact's radius and height and the slope there.
fn centre<S: Scalar>(nose_radius: f64, rho: S, height: S, slope: S) -> (S, S) {
    let along_z = (slope.squared() + 1.0).sqrt().recip() * nose_radius;
    (rho - slope * along_z, height + along_z)
}

fn series(cut: Cut<'_>, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
    let (mut points, mut rays) = (Evaluation::default(), Rays::default());
    for batch in batches(theta.len()) {
        let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
        let rays = rays.at(theta.iter().map(|theta| theta[0])).zip(theta);
        let rays = rays.map(|(ray, theta)| TurningRay::from(ray, Taylor(*theta)));
        points.set(rays.clone().zip(rho).map(|(ray, rho)| {
            let (x, y) = ray.point(Taylor(*rho));
            (x.0, y.0)
        }));
        points.series(cut.surface)?;
        for ((i, at), ray) in batch.enumerate().zip(rays) {
            let slope = ray.along(Taylor(points.zx[i]), Taylor(points.zy[i]));
            let (x, z) = centre(
                cut.tool.nose_radius,
                Taylor(rho[i]),
                Taylor(points.z[i]),
                slope,
            );
            (out.x[at], out.z[at]) = (x.0, z.0);
        }
    }
    Ok(())
}

/// Computes the rates. The gradient's change along the ray gives g_ρρ and g_ρθ at once.
fn rates(cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
    let (mut points, mut rays) = (Evaluation::default(), Rays::default());
    for batch in batches(theta.len()) {
        let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
        let rays = rays.at(theta.iter().copied());
        points.set(rays.clone().zip(rho).map(|(ray, rho)| ray.line(*rho)));
        points.series(cut.surface)?;
        for ((i, at), ray) in batch.enumerate().zip(rays) {
            let (zx, zy) = (&points.zx[i], &points.zy[i]);
            let (slope, across) = (ray.along(zx[0], zy[0]), ray.across(zx[0], zy[0]));
            let slope_rho = ray.along(zx[1], zy[1]);
            let slope_theta = across + rho[i] * ray.across(zx[1], zy[1]);
            let w = (1.0 + slope * slope).sqrt();
            let lever = cut.tool.nose_radius / (w * w * w);
            out.x_theta[at] = -lever * slope_theta;
            out.x_rho[at] = 1.0 - lever * slope_rho;
            out.z_theta[at] = rho[i] * across;
            out.z_x[at] = slope;
        }
    }
    Ok(())
}
