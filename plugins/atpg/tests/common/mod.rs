//! Parts of the papers, and laws of the feed strategy on them.
#![allow(dead_code, reason = "every test program uses its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use turnpath_atpg::AtpgFeed;
use turnpath_core::{
    CentreBuffers, Compensator, Direction, FeedStrategy, Job, Locus, Machine, NM, Onward,
    ParamValue, Params, Part, Piece, RadialRange, Result, Setup, SpindleLaw, SpiralLaw, Strategy,
    SurfaceModel, Tolerance, Tool, ToolLocus,
};
use turnpath_surfaces::{Astigmatic, OffAxisParaboloid};

/// A job and the locus that it is cut on.
pub struct Case {
    pub job: Job,
    pub locus: ToolLocus,
}

impl Case {
    pub fn new(
        surface: Arc<dyn SurfaceModel>,
        compensator: Arc<dyn Compensator>,
        aperture: f64,
        nose_radius: f64,
        tolerance_nm: f64,
    ) -> Self {
        let outer = 0.5 * aperture;
        let tool = Tool {
            nose_radius,
            included_angle: None,
            clearance_angle: None,
            misfit: turnpath_core::Misfit::Refuse,
        };
        let job = Job {
            part: Part {
                aperture_radius: outer,
                inner_radius: 0.0,
            },
            tool,
            tolerance: Tolerance {
                interpolation: tolerance_nm * NM,
                residual: tolerance_nm * NM,
            },
            range: RadialRange { inner: 0.0, outer },
            direction: Direction::Outward,
            spindle: SpindleLaw::constant(500.0 * TAU / 60.0),
            machine: Machine::default(),
        };
        Self {
            job,
            locus: ToolLocus::new(surface, compensator, tool),
        }
    }

    pub fn inward(mut self) -> Self {
        self.job.direction = Direction::Inward;
        self
    }

    /// With a hole of the given radius.
    pub fn with_hole(mut self, inner: f64) -> Self {
        self.job.part.inner_radius = inner;
        self.job.range.inner = inner;
        self
    }

    pub fn setup(&self) -> Setup<'_> {
        Setup {
            job: &self.job,
            locus: &self.locus,
        }
    }

    /// The law of feed `atpg`.
    pub fn law(&self, residual: &str, fit: &str) -> Result<SpiralLaw> {
        let params = words(&[("residual", residual), ("fit", fit)]);
        let mut plan = AtpgFeed::new(&params)?.plan(self.setup())?;
        let (mut law, mut pieces) = (SpiralLaw::new(), Vec::new());
        while plan.extend(self.setup(), &mut pieces)? == Onward::More {}
        for piece in pieces {
            law.push(piece.length, piece.coefficients);
        }
        Ok(law)
    }

    /// The held feed at each of `angles` even angles, at one radius.
    pub fn held(&self, rho: f64, angles: usize) -> Vec<f64> {
        let theta: Vec<f64> = (0..angles)
            .map(|i| TAU * i as f64 / angles as f64)
            .collect();
        let mut feed = vec![f64::NAN; angles];
        let residual = self.job.tolerance.residual;
        self.locus
            .held_feed(
                residual,
                self.locus.radial(),
                &theta,
                &vec![rho; angles],
                &mut feed,
            )
            .unwrap();
        feed
    }

    /// Revolutions of the fastest law that holds the residual at every angle: ∫ dρ/min F, by
    /// brute force.
    pub fn fewest_revolutions(&self, radii: usize, angles: usize) -> f64 {
        let RadialRange { inner, outer } = self.job.range;
        let step = (outer - inner) / radii as f64;
        let turns = (0..radii).map(|i| {
            let feed = self.held(inner + (i as f64 + 0.5) * step, angles);
            step / feed.into_iter().fold(f64::INFINITY, f64::min)
        });
        turns.sum()
    }

    /// The nose centre's Z at the given places.
    pub fn heights(&self, theta: &[f64], x: &[f64]) -> Vec<f64> {
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        self.locus.centre(theta, x, room.as_centres()).unwrap();
        room.z
    }
}

/// Parameters that are words.
pub fn words(pairs: &[(&str, &str)]) -> Params {
    let mut params = Params::new();
    for (name, word) in pairs {
        params.set(*name, ParamValue::Text((*word).to_owned()));
    }
    params
}

/// AST-5: z = 0.08 ρ² sin 2θ, aperture 5 mm, R = 1 mm, 100 nm.
pub fn ast_5(compensator: impl Compensator + 'static) -> Case {
    let surface = Astigmatic::new(&Params::new().with("k", 0.08)).unwrap();
    Case::new(Arc::new(surface), Arc::new(compensator), 5.0, 1.0, 100.0)
}

/// AST-50: 4.8 µm over 50 mm, R = 1.04 mm, 10 nm.
pub fn ast_50(compensator: impl Compensator + 'static) -> Case {
    let surface = Astigmatic::new(&Params::new().with("k", 3.84e-6)).unwrap();
    Case::new(Arc::new(surface), Arc::new(compensator), 50.0, 1.04, 10.0)
}

/// OAP-213: vertex radius and distance 915 mm, 213 mm, R = 1.04 mm, 10 nm.
pub fn oap_213(compensator: impl Compensator + 'static) -> Case {
    let params = Params::new()
        .with("vertex_radius", 915.0)
        .with("off_axis_distance", 915.0);
    let surface = OffAxisParaboloid::new(&params).unwrap();
    Case::new(Arc::new(surface), Arc::new(compensator), 213.0, 1.04, 10.0)
}

/// The law's ρ and dρ/dN after `n` revolutions, from its own pieces.
pub fn rate_at(law: &SpiralLaw, n: f64) -> (f64, f64) {
    let series = law.series(n);
    (series[0], series[1])
}

/// Where the law's pieces join.
pub fn joints(law: &SpiralLaw) -> impl Iterator<Item = f64> {
    law.pieces().iter().skip(1).map(|piece: &Piece| piece.start)
}
