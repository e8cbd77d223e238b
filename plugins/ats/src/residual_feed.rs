//! The residual feed with its derivatives. It is smooth where it is capped.
//!
//! It is the host's residual feed f with two differences. It keeps a margin, and it takes (f⁻⁸ +
//! cap⁻⁸)^(−1/8) in place of min(f, cap), so that it has derivatives wherever the surface has them.

use turnpath_plugin::locus::{LARGEST_FEED, LEAST_GAP};
use turnpath_plugin::prelude::*;

use crate::jet::Jet;
use crate::sections::{Section, Sections};

/// The part by which the feed stays below the one that keeps the residual. The margin is for X's
/// own interpolation error, to which the sampler `ats` gives a thousandth of the distance between
/// passes. It costs as much in revolutions.
pub const MARGIN: f64 = 1.5e-3;

/// The constants of the formula.
#[derive(Debug, Clone, Copy)]
struct Law {
    radial: Radial,
    nose_radius: f64,
    residual: f64,
    misfit: Misfit,
}

impl Law {
    /// The feed from the slope and the second derivative of the radial section at the contact. With
    /// y = (cap/f)² it is cap/(1 + y⁴)^(1/8). Where the nose does not fit, it is the cap.
    fn feed<S: Scalar>(&self, slope: S, second: S) -> S {
        let cap = LARGEST_FEED * self.nose_radius;
        let squared = slope.squared() + 1.0;
        let gap = -(second / (squared * squared.sqrt()) * self.nose_radius) + 1.0;
        let gap = match self.misfit {
            Misfit::Refuse => gap,
            Misfit::CutWhatFits => {
                let least = S::constant(LEAST_GAP);
                S::select(gap.less(least), least, gap)
            }
        };
        let scale = cap * cap / (8.0 * self.nose_radius * self.residual);
        let y = match self.radial {
            Radial::Contact => squared * gap * scale,
            Radial::Centre => squared / gap * scale,
        };
        let none = S::constant(0.0);
        let y = S::select(y.less(none), none, y);
        let eighth = (y.squared().squared() + 1.0).sqrt().sqrt().sqrt();
        eighth.recip() * (cap * (1.0 - MARGIN))
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

/// Computes feeds in batches.
pub struct ResidualFeed<'a> {
    setup: Setup<'a>,
    law: Law,
    centres: CentreBuffers,
    sections: Sections,
    evaluated: Vec<Section>,
    pairs: Vec<(f64, f64)>,
}

impl<'a> ResidualFeed<'a> {
    /// The residual feed of one task and locus.
    pub fn new(setup: Setup<'a>) -> Self {
        Self {
            setup,
            law: Law {
                radial: setup.locus.radial(),
                nose_radius: setup.task.tool.nose_radius,
                residual: setup.task.tolerance.residual,
                misfit: setup.task.tool.misfit,
            },
            centres: CentreBuffers::default(),
            sections: Sections::default(),
            evaluated: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// The feed at each (θ, ρ), as a function of both.
    pub fn jets(&mut self, theta: &[f64], rho: &[f64], out: &mut Vec<Jet>) -> Result<()> {
        self.touch(theta, rho)?;
        let surface = self.setup.locus.surface();
        let feet = &self.centres.foot;
        self.sections
            .evaluate(surface, theta, feet, &mut self.evaluated)?;
        out.clear();
        let law = self.law;
        out.extend(
            self.evaluated
                .iter()
                .zip(feet)
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
        out.clear();
        let law = self.law;
        out.extend(
            self.pairs
                .iter()
                .map(|(slope, second)| law.feed(*slope, *second)),
        );
        check(theta, rho, out.iter().copied())
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
