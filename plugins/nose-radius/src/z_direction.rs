//! Compensation along z: X stays as the feed gives it, and the nose comes down until it touches.

use turnpath_plugin::prelude::*;
use turnpath_plugin::registers::in_widest;
use turnpath_plugin::strip::STRIP;

use crate::descent::{Descents, Heights, MovingFeet, StillFeet};
use crate::foot::FootFinder;
use crate::polar::{Evaluation, batches};
use crate::touch::{Touch, rise};

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

    fn curvature_outside(
        &self,
        cut: Cut<'_>,
        part: RadialRange,
        region: RadialRange,
    ) -> Result<Option<interference::Extreme>> {
        interference::curvature_outside(cut, part, region).map(Some)
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
    let mut descents: Vec<Descents> = Vec::new();
    out.x.copy_from_slice(rho);
    for batch in batches(theta.len()) {
        let (theta, rho) = (&theta[batch.clone()], &rho[batch.clone()]);
        theta_0.clear();
        rho_0.clear();
        theta_0.extend(theta.iter().map(|theta| theta[0]));
        rho_0.extend(rho.iter().map(|rho| rho[0]));
        let touches = finder.find(cut, &theta_0, &rho_0)?;
        points.set(touches.iter().map(|touch| touch.ray.line(touch.foot())));
        descents.resize_with(touches.len().div_ceil(STRIP), Descents::none);
        let curves = theta.chunks(STRIP).zip(rho.chunks(STRIP));
        let strips = curves.zip(touches.chunks(STRIP));
        for (descents, ((theta, rho), touches)) in descents.iter_mut().zip(strips) {
            descents.begin(cut.tool.nose_radius, theta, rho, touches);
        }
        heights(cut.surface, &mut descents, &mut points, &mut out.z[batch])?;
    }
    Ok(())
}

/// Moves the feet along the curves, order by order, and the heights with them. The points begin as
/// the radial sections through the feet.
fn heights(
    surface: &dyn SurfaceModel,
    descents: &mut [Descents],
    points: &mut Evaluation<Series>,
    out: &mut [Series],
) -> Result<()> {
    points.series_to(OF_FOOT, surface)?;
    for (descents, strip) in descents.iter_mut().zip(points.strips()) {
        in_widest(StillFeet {
            descents,
            slopes: strip.slopes,
            curves: strip.curves,
        });
    }
    points.series_to(OF_FOOT, surface)?;
    for (descents, strip) in descents.iter_mut().zip(points.strips()) {
        in_widest(MovingFeet {
            descents,
            slopes: strip.slopes,
            curves: strip.curves,
        });
    }
    points.series_to(OF_HEIGHT, surface)?;
    let strips = points.strips().zip(out.chunks_mut(STRIP));
    for (descents, (strip, out)) in descents.iter().zip(strips) {
        in_widest(Heights {
            descents,
            z: strip.z,
            slopes: strip.slopes,
            out,
        });
    }
    Ok(())
}
