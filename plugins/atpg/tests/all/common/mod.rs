//! Parts of the papers, and laws of the feed `atpg` on them.
#![allow(dead_code, reason = "every test program uses its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

#[path = "../../../../../tests/support/planned.rs"]
mod planned;

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::models::model;
pub use planned::{Case, ast_5};
use turnpath_atpg::AtpgFeed;
use turnpath_core::{
    CentreBuffers, Compensator, Locus, ParamValue, Params, Piece, RadialRange, Result, SpiralLaw,
    Strategy,
};
use turnpath_surfaces::{Astigmatic, OffAxisParaboloid};

/// What the tests need of a case in addition.
pub trait AtpgCase {
    /// The law of feed `atpg`.
    fn plan_law(&self, residual: &str, fit: &str) -> Result<SpiralLaw>;
    /// The residual feed at each of `angles` even angles, at one radius.
    fn residual_feeds(&self, rho: f64, angles: usize) -> Vec<f64>;
    /// Revolutions of the fastest law that keeps the residual at every angle: ∫ dρ/min F, by brute
    /// force over `angles` even angles of a turn. Only those before the part repeats are looked at,
    /// which it does `folds` times in a turn.
    fn fewest_revolutions(&self, radii: usize, angles: usize, folds: usize) -> f64;
    /// The nose centre's Z at the given points.
    fn heights(&self, theta: &[f64], x: &[f64]) -> Vec<f64>;
}

impl AtpgCase for Case {
    fn plan_law(&self, residual: &str, fit: &str) -> Result<SpiralLaw> {
        let params = words(&[("residual", residual), ("fit", fit)]);
        self.law(&AtpgFeed::new(&params)?)
    }

    fn residual_feeds(&self, rho: f64, angles: usize) -> Vec<f64> {
        let theta = (0..angles).map(|i| TAU * i as f64 / angles as f64);
        self.residual_feeds_at(&theta.collect::<Vec<_>>(), rho)
    }

    fn fewest_revolutions(&self, radii: usize, angles: usize, folds: usize) -> f64 {
        let theta = (0..angles / folds).map(|i| TAU * i as f64 / angles as f64);
        let theta: Vec<f64> = theta.collect();
        let RadialRange { inner, outer } = self.task.range;
        let step = (outer - inner) / radii as f64;
        let turns = (0..radii).map(|i| {
            let feed = self.residual_feeds_at(&theta, inner + (i as f64 + 0.5) * step);
            step / feed.into_iter().fold(f64::INFINITY, f64::min)
        });
        turns.sum()
    }

    fn heights(&self, theta: &[f64], x: &[f64]) -> Vec<f64> {
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        self.locus.centre(theta, x, room.as_centres()).unwrap();
        room.z
    }
}

/// Parameters from pairs of words.
pub fn words(pairs: &[(&str, &str)]) -> Params {
    let mut params = Params::new();
    for (name, word) in pairs {
        params.set(*name, ParamValue::Text((*word).to_owned()));
    }
    params
}

/// AST-50: 4.8 µm over 50 mm, R = 1.04 mm, 10 nm.
pub fn ast_50(compensator: impl Compensator + 'static) -> Case {
    let surface = model::<Astigmatic>(&Params::new().with("k", 3.84e-6));
    Case::new(surface, Arc::new(compensator), 50.0, 1.04, 10.0)
}

/// OAP-213: vertex radius and distance 915 mm, 213 mm, R = 1.04 mm, 10 nm.
pub fn oap_213(compensator: impl Compensator + 'static) -> Case {
    let params = Params::new()
        .with("vertex_radius", 915.0)
        .with("off_axis_distance", 915.0);
    let surface = model::<OffAxisParaboloid>(&params);
    Case::new(surface, Arc::new(compensator), 213.0, 1.04, 10.0)
}

/// The law's ρ and dρ/dN after `n` revolutions, from its own pieces.
pub fn rate_at(law: &SpiralLaw, n: f64) -> (f64, f64) {
    let series = law.series(n);
    (series[0], series[1])
}

/// The positions where the law's pieces join.
pub fn joints(law: &SpiralLaw) -> impl Iterator<Item = f64> {
    law.pieces().iter().skip(1).map(|piece: &Piece| piece.start)
}
