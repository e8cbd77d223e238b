//! Compensation along z: X stays as the feed gives it, and the nose comes down until it touches.

use turnpath_plugin::prelude::*;

use crate::foot::FootFinder;
use crate::polar::{Evaluation, TurningRay, batches};
use crate::touch::{Touch, rise};

/// The least −F_d·R that the motion of the foot uses. It is 1/cos³φ − Rκ. It is above zero at a
/// highest point, except where the section osculates the nose: there the foot moves without bound.
const LEAST_STEEPNESS: f64 = 1e-6;

/// What the motion of the foot takes: how the slopes change.
const OF_FOOT: SeriesOrders = SeriesOrders {
    heights: 1,
    slopes: 1,
};
/// What the height takes, with the foot's motion known to order 1.
const OF_HEIGHT: SeriesOrders = SeriesOrders {
    heights: ORDER,
    slopes: 2,
};

/// X = ρ; Z = max over ρ′ of g(θ, ρ′) + sqrt(R² − (ρ − ρ′)²), ρ′ within the edge's reach.
///
/// X does not follow the surface, so the X axis moves as smoothly as the feed. Where Rκ < 1 over
/// the reach, there is only one foot. With [`Misfit::CutWhatFits`] a scan of the whole reach looks
/// for the foot. Where the edge ends before the normal does, it touches with its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ZDirection;

impl Strategy for ZDirection {
    const NAME: &'static str = "z-direction";
    const SUMMARY: &'static str = "X as the feed says, Z where the nose first touches from above";
    const SOURCE: &'static str = "Wang et al. 2019, eq. 16–18: the foot of the nose's circle on \
        the radial section, here as the maximum over the edge";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl Compensator for ZDirection {
    fn radial(&self) -> Radial {
        Radial::Centre
    }

    fn cuts_what_fits(&self) -> bool {
        true
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], mut out: Centres<'_>) -> Result<()> {
        let radius = cut.tool.nose_radius;
        at_feet(cut, theta, rho, |at, foot| {
            foot.write_centre(radius, &mut out, at);
        })
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

    /// The height is extreme at the foot, so the motion of the foot itself does not count.
    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        mut out: Rates<'_>,
    ) -> Option<Result<()>> {
        Some(at_feet(cut, theta, rho, |at, foot| {
            foot.write_rates(&mut out, at);
        }))
    }

    fn centre_and_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        mut centres: Centres<'_>,
        mut rates: Rates<'_>,
    ) -> Option<Result<()>> {
        let radius = cut.tool.nose_radius;
        Some(at_feet(cut, theta, rho, |at, foot| {
            foot.write_centre(radius, &mut centres, at);
            foot.write_rates(&mut rates, at);
        }))
    }
}

/// A touch, and the surface at its foot.
struct Foot<'a> {
    touch: &'a Touch,
    height: f64,
    /// ∂z/∂x and ∂z/∂y.
    slopes: [f64; 2],
}

impl Foot<'_> {
    fn write_centre(&self, radius: f64, out: &mut Centres<'_>, at: usize) {
        out.x[at] = self.touch.rho;
        out.z[at] = self.height + rise(radius, self.touch.offset);
        out.foot[at] = self.touch.foot();
    }

    fn write_rates(&self, out: &mut Rates<'_>, at: usize) {
        let (touch, [zx, zy]) = (self.touch, self.slopes);
        out.x_theta[at] = 0.0;
        out.x_rho[at] = 1.0;
        out.z_theta[at] = touch.foot() * touch.ray.across(zx, zy);
        out.z_x[at] = touch.ray.along(zx, zy);
    }
}

/// Finds the foot at each (θ, ρ), and gives it with its index.
fn at_feet(
    cut: Cut<'_>,
    theta: &[f64],
    rho: &[f64],
    mut take: impl FnMut(usize, Foot<'_>),
) -> Result<()> {
    let (mut finder, mut points) = (FootFinder::default(), Evaluation::default());
    for batch in batches(theta.len()) {
        let touches = finder.find(cut, &theta[batch.clone()], &rho[batch.clone()])?;
        points.set(touches.iter().map(|touch| touch.ray.point(touch.foot())));
        points.gradient(cut.surface)?;
        for ((i, touch), at) in touches.iter().enumerate().zip(batch) {
            let foot = Foot {
                touch,
                height: points.z[i],
                slopes: [points.zx[i], points.zy[i]],
            };
            take(at, foot);
        }
    }
    Ok(())
}

fn series(cut: Cut<'_>, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
    let (mut finder, mut points) = (FootFinder::default(), Evaluation::default());
    let (mut theta_0, mut rho_0) = (Vec::new(), Vec::new());
    let mut descents = Vec::new();
    for batch in batches(theta.len()) {
        let curves = theta[batch.clone()].iter().zip(&rho[batch.clone()]);
        theta_0.clear();
        rho_0.clear();
        theta_0.extend(curves.clone().map(|(theta, _)| theta[0]));
        rho_0.extend(curves.clone().map(|(_, rho)| rho[0]));
        let touches = finder.find(cut, &theta_0, &rho_0)?;
        descents.clear();
        descents.extend(
            curves
                .zip(touches)
                .map(|((theta, rho), touch)| Descent::new(theta, rho, touch)),
        );
        heights(cut, &mut descents, &mut points)?;
        for (descent, at) in descents.iter().zip(batch) {
            (out.x[at], out.z[at]) = (descent.rho.0, descent.height.0);
        }
    }
    Ok(())
}

/// Moves the feet along the curves, order by order, and the heights with them.
fn heights(cut: Cut<'_>, descents: &mut [Descent], points: &mut Evaluation<Series>) -> Result<()> {
    let radius = cut.tool.nose_radius;
    points.set(descents.iter().map(Descent::section));
    points.series_to(OF_FOOT, cut.surface)?;
    for (i, descent) in descents.iter_mut().enumerate() {
        descent.learn_steepness(radius, points.zx[i][1], points.zy[i][1]);
    }
    points.set(descents.iter().map(Descent::curve));
    points.series_to(OF_FOOT, cut.surface)?;
    for (i, descent) in descents.iter_mut().enumerate() {
        descent.move_foot(radius, points.zx[i], points.zy[i]);
    }
    points.set(descents.iter().map(Descent::curve));
    points.series_to(OF_HEIGHT, cut.surface)?;
    for (i, descent) in descents.iter_mut().enumerate() {
        descent.learn_height(radius, points.z[i], points.zx[i], points.zy[i]);
    }
    Ok(())
}

/// The descent of the nose along one curve. ρ_t(t) = ρ(t) + d(t) is the foot.
///
/// With h(t, d) = g(θ(t), ρ(t) + d) + sqrt(R² − d²) and F = ∂h/∂d, the foot has F = 0. A foot d₀ +
/// at that is right to order 1 leaves F = F₂t² + …, and Z = max h then still lacks −F₂²/(2F_d)·t⁴ +
/// O(t⁵). So three series of the surface give Z exactly through order 4.
struct Descent {
    touch: Touch,
    ray: TurningRay,
    rho: Taylor<f64>,
    offset: Taylor<f64>,
    /// F_d at t = 0, negative; −∞ if the end of the edge touches, whose offset does not move.
    steepness: f64,
    height: Taylor<f64>,
}

impl Descent {
    fn new(theta: &Series, rho: &Series, touch: &Touch) -> Self {
        Self {
            touch: *touch,
            ray: TurningRay::at(*theta),
            rho: Taylor(*rho),
            offset: Taylor::constant(touch.offset),
            steepness: f64::NEG_INFINITY,
            height: Taylor::constant(f64::NAN),
        }
    }

    /// The radial section through the foot.
    fn section(&self) -> (Series, Series) {
        self.touch.ray.line(self.touch.foot())
    }

    /// The foot's curve, to the order that is known so far.
    fn curve(&self) -> (Series, Series) {
        self.ray.point(self.rho + self.offset)
    }

    /// F_d = g_ρρ − R²/(R² − d²)^{3/2}, from the gradient's change along the section.
    fn learn_steepness(&mut self, radius: f64, zx_rho: f64, zy_rho: f64) {
        if !self.touch.at_edge_end {
            let rise = rise(radius, self.touch.offset);
            let second = self.touch.ray.along(zx_rho, zy_rho);
            let steepness = second - radius * radius / (rise * rise * rise);
            self.steepness = steepness.min(-LEAST_STEEPNESS / radius);
        }
    }

    /// F(t) = g_ρ − d/sqrt(R² − d²) at the foot, in its first `N` coefficients.
    fn tilt<const N: usize>(&self, radius: f64, zx: Series, zy: Series) -> Taylor<f64, N> {
        let offset = Taylor::from_series(self.offset.0);
        self.ray.along(zx, zy) - offset / rise(radius, offset)
    }

    /// Gives the foot its speed: F₁ = 0.
    fn move_foot(&mut self, radius: f64, zx: Series, zy: Series) {
        self.offset.0[1] = -self.tilt::<2>(radius, zx, zy).0[1] / self.steepness;
    }

    /// The height at the foot, and what Z still lacks in the fourth order.
    fn learn_height(&mut self, radius: f64, z: Series, zx: Series, zy: Series) {
        let rest = self.tilt::<3>(radius, zx, zy).0[2];
        self.height = Taylor(z) + rise(radius, self.offset);
        self.height.0[4] -= 0.5 * rest * rest / self.steepness;
    }
}
