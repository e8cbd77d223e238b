//! The residual feed with its derivatives. It is smooth where it is capped.
//!
//! It is the host's residual feed f with three differences. It keeps a margin. It takes (f⁻⁸ +
//! cap⁻⁸)^(−1/8) in place of min(f, cap), so that it has derivatives wherever the surface has them.
//! And a large feed is that of the circle of curvature, times one factor for the whole part: the
//! least ratio of the host's feed, which knows how the curvature changes within a feed, at the
//! places where a step may have its middle.

use turnpath_plugin::locus::{CIRCLES_FROM, CuspFeed};
use turnpath_plugin::prelude::*;

use crate::jet::Jet;
use crate::sections::{Section, Sections};

/// The part by which the feed stays below the one that keeps the residual. The margin is for X's
/// own interpolation error, to which the sampler `ats` gives a thousandth of the distance between
/// passes. It costs as much in revolutions.
pub const MARGIN: f64 = 1.5e-3;

/// The cap on the parabola's feed, as a part of the nose radius. Where the feed comes near to it,
/// the circles count and not the parabola.
const PARABOLA_CAP: f64 = 0.1;
/// The 1 − Rκ below which the feed is no longer that of the curvature, where ρ is the centre's X.
/// It goes over smoothly to the feed at half of this 1 − Rκ, and keeps that where the nose does not
/// fit at all. Beyond the part the nose need not fit; whether the path goes there is the host's
/// question. The cusps on the way are too high, so the part is small.
const CENTRES_FIT: f64 = 0.02;
/// The same where ρ is the contact's radius. There the feed of the curvature grows beyond all bounds
/// in such hollows, and no law follows it along the angle. This one is smaller and costs revolutions.
const CONTACTS_FIT: f64 = 0.2;

/// The constants of the formula.
#[derive(Debug, Clone, Copy)]
struct Law {
    radial: Radial,
    nose_radius: f64,
    residual: f64,
    circles: CuspFeed,
    /// The factor of the feed of circles; 1 until the first feed needs it.
    factor: f64,
}

impl Law {
    /// The feed from the slope and the second derivative of the radial section at the contact. With
    /// y = (cap/f)² it is cap/(1 + y⁴)^(1/8).
    fn feed<S: Scalar>(&self, slope: S, second: S) -> S {
        let cap = PARABOLA_CAP * self.nose_radius;
        let squared = slope.squared() + 1.0;
        let gap = fitting(self.gap(slope, second), self.fit());
        let scale = cap * cap / (8.0 * self.nose_radius * self.residual);
        let y = match self.radial {
            Radial::Contact => squared * gap * scale,
            Radial::Centre => squared / gap * scale,
        };
        let eighth = (y.squared().squared() + 1.0).sqrt().sqrt().sqrt();
        let feed = eighth.recip() * (cap * (1.0 - MARGIN));
        match self.circles.needs_circles(gap) {
            true => self.with_circles(feed, slope, gap, y),
            false => feed,
        }
    }

    /// The least 1 − Rκ at which the feed is that of the curvature.
    fn fit(&self) -> f64 {
        match self.radial {
            Radial::Centre => CENTRES_FIT,
            Radial::Contact => CONTACTS_FIT,
        }
    }

    /// 1 − Rκ of the radial section.
    fn gap<S: Scalar>(&self, slope: S, second: S) -> S {
        let squared = slope.squared() + 1.0;
        self.circles.gap(second / (squared * squared.sqrt()))
    }

    /// Whether circles count at some of these slopes and second derivatives.
    fn needs_circles(&self, mut sections: impl Iterator<Item = (f64, f64)>) -> bool {
        sections.any(|(slope, second)| self.circles.needs_circles(self.gap(slope, second)))
    }

    /// Whether the feed is that of circles alone, where the nose fits.
    fn is_of_circles(&self, slope: f64, second: f64) -> bool {
        let gap = self.gap(slope, second);
        let fits = match self.radial {
            Radial::Centre => gap >= CENTRES_FIT,
            // Where this feed is that of a smaller curvature, it may still be too large: the
            // curvature may change within it.
            Radial::Contact => gap > 0.0,
        };
        let fitted = fitting(gap, self.fit());
        fits && self.circles.flat_spacing(fitted) >= CIRCLES_FROM * self.nose_radius
    }

    /// The feed that passes from the parabola's to that of circles.
    fn with_circles<S: Scalar>(&self, parabola: S, slope: S, gap: S, y: S) -> S {
        let free = y.sqrt().recip() * (PARABOLA_CAP * self.nose_radius);
        let share = self.circles.share(self.circles.flat_spacing(gap));
        let cap = self.circles.cap(slope, gap);
        let ratio = cap.squared() / (free.squared() * self.circles.correction(gap));
        let eighth = (ratio.squared().squared() + 1.0).sqrt().sqrt().sqrt();
        let circles = cap / eighth * (self.factor * (1.0 - MARGIN));
        parabola + share * (circles - parabola)
    }

    /// The feed as a function of (θ, ρ), from the section at the contact, whose radius is a.
    fn jet(&self, section: &Section, a: f64) -> Jet {
        let (slope, second) = (section.slope.to_dual(), section.second.to_dual());
        let feed = Jet::from_dual(self.feed(slope, second));
        match self.radial {
            Radial::Contact => feed,
            Radial::Centre => {
                let lean = slope / (slope.squared() + 1.0).sqrt() * -self.nose_radius;
                let centre = Jet::radius(a).plus(1.0, &Jet::from_dual(lean));
                feed.through(&centre.inverse(a))
            }
        }
    }
}

/// 1 − Rκ, but not below half of `fit`, with three continuous derivatives. From `fit` on it is `gap`
/// to the last bit.
fn fitting<S: Scalar>(gap: S, fit: f64) -> S {
    let (none, whole) = (S::constant(0.0), S::constant(fit));
    let fits = !gap.less(whole);
    if !(!fits).any() {
        return gap;
    }
    let way = S::select(gap.less(none), none, gap) / fit;
    // The integral of a step of two continuous derivatives, which is a half at the end.
    let rise = way * way * way * way * ((way - 3.0) * way + 2.5);
    S::select(fits, gap, (rise + 0.5) * fit)
}

/// Computes feeds in batches.
pub struct ResidualFeed<'a> {
    setup: Setup<'a>,
    law: Law,
    /// The circle at which the law begins, mm.
    start: f64,
    factor: Option<f64>,
    centres: CentreBuffers,
    sections: Sections,
    evaluated: Vec<Section>,
    pairs: Vec<(f64, f64)>,
}

impl<'a> ResidualFeed<'a> {
    /// The residual feed of one task and locus, for a law that begins at the circle `start`, mm.
    ///
    /// `factor` is that of the feed of circles; `None` until a feed has needed it.
    pub fn new(setup: Setup<'a>, start: f64, factor: Option<f64>) -> Self {
        let (radial, tool) = (setup.locus.radial(), &setup.task.tool);
        let residual = setup.task.tolerance.residual;
        Self {
            setup,
            law: Law {
                radial,
                nose_radius: tool.nose_radius,
                residual,
                circles: CuspFeed::new(residual, radial, tool),
                factor: factor.unwrap_or(1.0),
            },
            start,
            factor,
            centres: CentreBuffers::default(),
            sections: Sections::default(),
            evaluated: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// The factor of the feed of circles; `None` as long as no feed needed it.
    pub fn factor(&self) -> Option<f64> {
        self.factor
    }

    /// The feed at each (θ, ρ), as a function of both.
    pub fn jets(&mut self, theta: &[f64], rho: &[f64], out: &mut Vec<Jet>) -> Result<()> {
        self.touch(theta, rho)?;
        let surface = self.setup.locus.surface();
        let feet = &self.centres.foot;
        self.sections
            .evaluate(surface, theta, feet, &mut self.evaluated)?;
        let section = |section: &Section| (section.slope.value, section.second.value);
        let sections = self.evaluated.iter().map(section);
        if self.factor.is_none() && self.law.needs_circles(sections) {
            self.find_factor()?;
        }
        out.clear();
        let law = self.law;
        out.extend(
            self.evaluated
                .iter()
                .zip(&self.centres.foot)
                .map(|(section, foot)| law.jet(section, *foot)),
        );
        check(theta, rho, out.iter().map(|jet| jet.value))
    }

    /// The values of the feed at each (θ, ρ), without derivatives.
    pub fn values(&mut self, theta: &[f64], rho: &[f64], out: &mut Vec<f64>) -> Result<()> {
        self.touch(theta, rho)?;
        let surface = self.setup.locus.surface();
        self.sections
            .values(surface, theta, &self.centres.foot, &mut self.pairs)?;
        if self.factor.is_none() && self.law.needs_circles(self.pairs.iter().copied()) {
            self.find_factor()?;
        }
        out.clear();
        let law = self.law;
        out.extend(
            self.pairs
                .iter()
                .map(|(slope, second)| law.feed(*slope, *second)),
        );
        check(theta, rho, out.iter().copied())
    }

    /// Finds the factor, from all places of the range whose feed is that of circles.
    ///
    /// No pass lies before the circle at which the law begins. So a step whose middle lies at a
    /// distance d from the circle is at most 2d. Where the host's feed is larger than that, every
    /// step holds the residual.
    fn find_factor(&mut self) -> Result<()> {
        let Setup { task, locus } = self.setup;
        let (residual, radial) = (task.tolerance.residual, locus.radial());
        // The factor of this one is known, so it does not look for it again.
        let mut local = ResidualFeed::new(self.setup, self.start, Some(1.0));
        let (start, mut host, mut own) = (self.start, Vec::new(), Vec::new());
        let [least] = extreme::largest(task.range, &mut |theta, rho, out| {
            host.resize(theta.len(), f64::NAN);
            locus.residual_feed(residual, radial, theta, rho, &mut host)?;
            local.values(theta, rho, &mut own)?;
            let feeds = host.iter().zip(&own).zip(&local.pairs).zip(rho);
            for (out, (((host, own), (slope, second)), rho)) in out.iter_mut().zip(feeds) {
                let held = host * (1.0 - MARGIN);
                let counts = local.law.is_of_circles(*slope, *second);
                *out = [match counts && 2.0 * (rho - start).abs() > held {
                    true => -held / own,
                    false => -1.0,
                }];
            }
            Ok(())
        })?;
        self.law.factor = (-least.value).min(1.0);
        self.factor = Some(self.law.factor);
        Ok(())
    }

    fn touch(&mut self, theta: &[f64], rho: &[f64]) -> Result<()> {
        self.centres.resize(theta.len());
        self.setup
            .locus
            .centre(theta, rho, self.centres.as_centres())
    }
}

/// Checks that every feed is a number above 0.
fn check(theta: &[f64], rho: &[f64], feeds: impl Iterator<Item = f64>) -> Result<()> {
    for ((feed, theta), rho) in feeds.zip(theta).zip(rho) {
        if !(feed.is_finite() && feed > 0.0) {
            let (sin, cos) = Scalar::sin_cos(*theta);
            return Err(StrategyError::failed(format!(
                "no feed can be found at x = {:.4} mm, y = {:.4} mm: the surface or the tool \
                 centre has no value there (the path goes on beyond the rim until the slowest \
                 angle has passed it); choose a smaller aperture, or feed `atpg`",
                rho * cos,
                rho * sin
            )));
        }
    }
    Ok(())
}
