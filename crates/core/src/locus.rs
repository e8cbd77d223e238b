//! The tool locus: where the nose centre goes for a C angle and a radial parameter.

use std::sync::Arc;

pub use crate::cusp::{CIRCLES_FROM, CuspFeed, LEAST_GAP, LocalFeeds, PARABOLA_TO, smooth_step};
use crate::neighbours::{FeedSearch, Neighbours};
pub use crate::profile::{Profile, profile_at};
use crate::tally::SERIES;
use crate::{
    CentreSeries, Centres, Compensator, Cut, Misfit, Radial, Rates, Result, Series, SurfaceModel,
    Tool, fit,
};

/// The locus of the tool as strategies use it. It also gives access to the bare surface. Calls are
/// in batches; all slices of one call have the same length.
pub trait Locus: Send + Sync {
    /// The bare surface.
    fn surface(&self) -> &dyn SurfaceModel;

    /// What the radial parameter ρ means.
    fn radial(&self) -> Radial;

    /// The nose centre and the contact for each (θ, ρ).
    fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()>;

    /// The order-4 series of the nose centre along the curves (θ(t), ρ(t)).
    fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()>;

    /// The partial rates of the nose centre at each (θ, ρ).
    fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()>;

    /// The feed dρ/dN, mm, that leaves cusps of height `residual` (mm) at each (θ, ρ).
    ///
    /// A small feed is sqrt(8Rε/(1 − Rκ))/w if ρ is the contact's radius, and sqrt(8Rε(1 − Rκ))/w
    /// if ρ is the centre's X. κ and w are those of the contact. From a flat spacing of R/15 on
    /// ([`CuspFeed::flat_spacing`]), the feed is that of passes half a feed to either side of ρ
    /// whose cusp is `residual` high, as far as the noses meet within their edges
    /// ([`CuspFeed::cap`]). Between R/25 and R/15 it passes smoothly from one to the other. The feed
    /// is NaN where the surface has no curvature. With a tool that cuts
    /// what fits, 1 − Rκ counts as at least [`LEAST_GAP`], and the profile as its circle of
    /// curvature.
    ///
    /// `radial` overrides the meaning of ρ.
    fn residual_feed(
        &self,
        residual: f64,
        radial: Radial,
        theta: &[f64],
        rho: &[f64],
        feed: &mut [f64],
    ) -> Result<()>;

    /// The least feed over all angles at each radius `rho`, mm, that leaves cusps of height `residual`
    /// (mm), with ρ in the locus's own meaning: that of
    /// [`least_feeds_at`](crate::ring::least_feeds_at). `None` from a locus that does not
    /// look for it. One that does may look at several radii in parallel.
    fn least_residual_feeds(
        &self,
        residual: f64,
        rho: &[f64],
        least: &mut [f64],
    ) -> Option<Result<()>> {
        let _ = (residual, rho, least);
        None
    }
}

/// Buffers for the answer of [`Locus::centre`].
#[derive(Debug, Default, Clone)]
pub struct CentreBuffers {
    /// X of the nose centre, mm.
    pub x: Vec<f64>,
    /// Z of the nose centre, mm.
    pub z: Vec<f64>,
    /// Radius of the contact, mm.
    pub foot: Vec<f64>,
}

impl CentreBuffers {
    /// Resizes every buffer to `count` points.
    pub fn resize(&mut self, count: usize) {
        for places in [&mut self.x, &mut self.z, &mut self.foot] {
            places.resize(count, f64::NAN);
        }
    }

    /// The buffers as slices to write to.
    pub fn as_centres(&mut self) -> Centres<'_> {
        Centres {
            x: &mut self.x,
            z: &mut self.z,
            foot: &mut self.foot,
        }
    }
}

/// The locus of one tool: a surface, a compensator and the tool.
#[derive(Clone)]
pub struct ToolLocus {
    surface: Arc<dyn SurfaceModel>,
    compensator: Arc<dyn Compensator>,
    tool: Tool,
}

impl ToolLocus {
    /// The locus of `tool` on `surface` as `compensator` places it.
    pub fn new(
        surface: Arc<dyn SurfaceModel>,
        compensator: Arc<dyn Compensator>,
        tool: Tool,
    ) -> Self {
        Self {
            surface,
            compensator,
            tool,
        }
    }

    fn cut(&self) -> Cut<'_> {
        Cut {
            surface: self.surface.as_ref(),
            tool: &self.tool,
        }
    }

    /// The nose centre, the contact and the partial rates of the centre for each (θ, ρ), as
    /// [`centre`](Locus::centre) and [`rates`](Locus::rates) give them.
    ///
    /// # Errors
    /// When the compensator or the surface fails.
    pub fn centre_and_rates(
        &self,
        theta: &[f64],
        rho: &[f64],
        centres: Centres<'_>,
        rates: Rates<'_>,
    ) -> Result<()> {
        let at_once = (
            Centres {
                x: &mut *centres.x,
                z: &mut *centres.z,
                foot: &mut *centres.foot,
            },
            Rates {
                x_theta: &mut *rates.x_theta,
                x_rho: &mut *rates.x_rho,
                z_theta: &mut *rates.z_theta,
                z_x: &mut *rates.z_x,
            },
        );
        let compensator = &self.compensator;
        match compensator.centre_and_rates(self.cut(), theta, rho, at_once.0, at_once.1) {
            Some(answer) => answer,
            None => {
                self.centre(theta, rho, centres)?;
                self.rates(theta, rho, rates)
            }
        }
    }

    fn fitted_series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
        let mut room = CentreBuffers::default();
        let places = fit::STENCIL * fit::LADDER;
        room.resize(places);
        let (mut at_theta, mut at_rho) = (vec![0.0; places], vec![0.0; places]);
        for (i, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            let steps = fit::steps(theta, rho, self.tool.nose_radius);
            for place in 0..places {
                let t = steps[place / fit::STENCIL] * ((place % fit::STENCIL) as f64 - 4.0);
                at_theta[place] = fit::evaluate(theta, t);
                at_rho[place] = fit::evaluate(rho, t);
            }
            self.centre(&at_theta, &at_rho, room.as_centres())?;
            out.x[i] = fit::fit(&steps, &by_step(&room.x));
            out.z[i] = fit::fit(&steps, &by_step(&room.z));
        }
        Ok(())
    }

    /// Whether passes can be placed with this meaning of ρ, and follow the profile there.
    fn places(&self, radial: Radial) -> bool {
        radial == self.compensator.radial() && self.tool.misfit == Misfit::Refuse
    }

    /// Computes the rates from the series along θ and along ρ.
    fn rates_from_series(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
        let along = |values: &[f64], rate: f64| -> Vec<Series> {
            values
                .iter()
                .map(|value| [*value, rate, 0.0, 0.0, 0.0])
                .collect()
        };
        let blank = vec![[0.0; 5]; theta.len()];
        let (mut x_turned, mut z_turned) = (blank.clone(), blank.clone());
        let turned = CentreSeries {
            x: &mut x_turned,
            z: &mut z_turned,
        };
        self.series(&along(theta, 1.0), &along(rho, 0.0), turned)?;
        let (mut x_moved, mut z_moved) = (blank.clone(), blank);
        let moved = CentreSeries {
            x: &mut x_moved,
            z: &mut z_moved,
        };
        self.series(&along(theta, 0.0), &along(rho, 1.0), moved)?;
        for i in 0..theta.len() {
            let slope = z_moved[i][1] / x_moved[i][1];
            out.x_theta[i] = x_turned[i][1];
            out.x_rho[i] = x_moved[i][1];
            out.z_x[i] = slope;
            out.z_theta[i] = z_turned[i][1] - slope * x_turned[i][1];
        }
        Ok(())
    }
}

fn by_step(values: &[f64]) -> [[f64; fit::STENCIL]; fit::LADDER] {
    std::array::from_fn(|step| std::array::from_fn(|j| values[step * fit::STENCIL + j]))
}

impl Locus for ToolLocus {
    fn surface(&self) -> &dyn SurfaceModel {
        self.surface.as_ref()
    }

    fn radial(&self) -> Radial {
        self.compensator.radial()
    }

    fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        self.compensator.centre(self.cut(), theta, rho, out)
    }

    fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
        SERIES.add(theta.len());
        let exact = CentreSeries {
            x: &mut *out.x,
            z: &mut *out.z,
        };
        match self.compensator.exact_series(self.cut(), theta, rho, exact) {
            Some(answer) => answer,
            None => self.fitted_series(theta, rho, out),
        }
    }

    fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
        let exact = Rates {
            x_theta: &mut *out.x_theta,
            x_rho: &mut *out.x_rho,
            z_theta: &mut *out.z_theta,
            z_x: &mut *out.z_x,
        };
        match self.compensator.exact_rates(self.cut(), theta, rho, exact) {
            Some(answer) => answer,
            None => self.rates_from_series(theta, rho, out),
        }
    }

    fn residual_feed(
        &self,
        residual: f64,
        radial: Radial,
        theta: &[f64],
        rho: &[f64],
        feed: &mut [f64],
    ) -> Result<()> {
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        self.centre(theta, rho, room.as_centres())?;
        let mut profile = vec![Profile::default(); theta.len()];
        profile_at(self.surface.as_ref(), theta, &room.foot, &mut profile)?;
        let law = CuspFeed::new(residual, radial, &self.tool);
        let (mut large, mut searches) = (Vec::new(), Vec::new());
        for (i, profile) in profile.iter().enumerate() {
            let local = law.feeds(profile);
            feed[i] = law.join(&local);
            if let Some(circles) = local.circles
                && local.parabola.is_finite()
                && self.places(radial)
            {
                large.push((i, local));
                searches.push(FeedSearch {
                    theta: theta[i],
                    rho: rho[i],
                    cap: law.cap(profile.slope, local.gap),
                    feed: circles,
                });
            }
        }
        let neighbours = Neighbours {
            cut: self.cut(),
            compensator: self.compensator.as_ref(),
        };
        neighbours.search(residual, &mut searches);
        for ((i, local), search) in large.into_iter().zip(&searches) {
            feed[i] = law.join(&LocalFeeds {
                circles: Some(search.feed),
                ..local
            });
        }
        Ok(())
    }
}
