//! Parts of the papers, and laws of the feed strategy on them. The program that includes this file
//! has `models.rs` as the module `models`.
#![allow(dead_code, reason = "every test program uses its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::models::model;
use turnpath_core::{
    CentreBuffers, Compensator, Continuation, Direction, FeedStrategy, Locus, Machine, NM,
    ParamValue, Params, Part, RadialRange, Result, Scalar, Setup, SpindleLaw, SpiralLaw,
    SurfaceModel, Task, Tolerance, Tool, ToolLocus,
};
use turnpath_surfaces::{Astigmatic, SinusoidalArray};

/// Speed of the spindle, rad/s.
const SPEED: f64 = 500.0 * TAU / 60.0;

/// A task, its spindle at a constant speed, and its locus.
pub struct Case {
    pub task: Task,
    pub spindle: SpindleLaw,
    pub locus: ToolLocus,
    pub surface: Arc<dyn SurfaceModel>,
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
        let task = Task {
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
            machine: Machine::default(),
            spindle_speed: SPEED,
        };
        Self {
            task,
            spindle: SpindleLaw::constant(SPEED),
            locus: ToolLocus::new(surface.clone(), compensator, tool),
            surface,
        }
    }

    pub fn inward(mut self) -> Self {
        self.task.direction = Direction::Inward;
        self
    }

    /// The case with a hole of the given radius.
    pub fn with_hole(mut self, inner: f64) -> Self {
        self.task.part.inner_radius = inner;
        self.task.range.inner = inner;
        self
    }

    pub fn setup(&self) -> Setup<'_> {
        Setup {
            task: &self.task,
            locus: &self.locus,
        }
    }

    /// The law of a feed strategy, which must end within a thousand calls.
    pub fn law(&self, feed: &dyn FeedStrategy) -> Result<SpiralLaw> {
        let mut plan = feed.plan(self.setup())?;
        let (mut law, mut pieces) = (SpiralLaw::new(), Vec::new());
        for _ in 0..1000 {
            let continuation = plan.extend(self.setup(), &mut pieces)?;
            if continuation == Continuation::End {
                for piece in pieces {
                    law.push(piece.length, piece.coefficients);
                }
                return Ok(law);
            }
        }
        panic!("a law without end");
    }

    /// The residual feed at one point.
    pub fn residual_feed(&self, theta: f64, rho: f64) -> f64 {
        self.residual_feeds_at(&[theta], rho)[0]
    }

    /// The residual feeds at these angles of one radius.
    pub fn residual_feeds_at(&self, theta: &[f64], rho: f64) -> Vec<f64> {
        let mut feed = vec![f64::NAN; theta.len()];
        let residual = self.task.tolerance.residual;
        let (radial, rho) = (self.locus.radial(), vec![rho; theta.len()]);
        self.locus
            .residual_feed(residual, radial, theta, &rho, &mut feed)
            .unwrap();
        feed
    }

    /// The nose centre (X, Z) at one point.
    pub fn centre(&self, theta: f64, rho: f64) -> [f64; 2] {
        let mut room = CentreBuffers::default();
        room.resize(1);
        self.locus
            .centre(&[theta], &[rho], room.as_centres())
            .unwrap();
        [room.x[0], room.z[0]]
    }

    /// The height of the crossing of two noses above the surface, by a search of the nearest point
    /// on finer and finer grids, mm.
    pub fn cusp(&self, theta: f64, one: [f64; 2], two: [f64; 2]) -> f64 {
        let radius = self.task.tool.nose_radius;
        let (dx, dz) = (two[0] - one[0], two[1] - one[1]);
        let half = 0.5 * (dx * dx + dz * dz).sqrt();
        let down = (radius * radius - half * half).sqrt() / (2.0 * half);
        let sign = dx.signum();
        let tip = [
            0.5 * (one[0] + two[0]) + sign * dz * down,
            0.5 * (one[1] + two[1]) - sign * dx * down,
        ];
        let (sin, cos) = Scalar::sin_cos(theta);
        let (mut foot, mut width, mut nearest) = (tip[0], 2.0 * half, f64::INFINITY);
        for _ in 0..30 {
            let feet: Vec<f64> = (-8..=8)
                .map(|i| foot + width * f64::from(i) / 8.0)
                .collect();
            let x: Vec<f64> = feet.iter().map(|foot| foot * cos).collect();
            let y: Vec<f64> = feet.iter().map(|foot| foot * sin).collect();
            let mut z = vec![f64::NAN; feet.len()];
            self.surface.heights(&x, &y, &mut z).unwrap();
            for (here, z) in feet.iter().zip(&z) {
                let off = [tip[0] - here, tip[1] - z];
                let distance = (off[0] * off[0] + off[1] * off[1]).sqrt();
                if distance < nearest {
                    (nearest, foot) = (distance, *here);
                }
            }
            width *= 0.5;
        }
        nearest
    }
}

/// AST-5: z = 0.08 ρ² sin 2θ, aperture 5 mm, R = 1 mm, 100 nm.
pub fn ast_5(compensator: impl Compensator + 'static) -> Case {
    let surface = model::<Astigmatic>(&Params::new().with("k", 0.08));
    Case::new(surface, Arc::new(compensator), 5.0, 1.0, 100.0)
}

/// MLA-5: 5 µm (cos 2π0.4x + cos 2π0.4y), radius 5 mm, R = 1 mm, 100 nm.
pub fn mla_5(compensator: impl Compensator + 'static) -> Case {
    let mut params = Params::new()
        .with("amplitude_x", 5e-3)
        .with("frequency_x", 0.4);
    params.set("form", ParamValue::Text("sum".to_owned()));
    let surface = model::<SinusoidalArray>(&params);
    Case::new(surface, Arc::new(compensator), 10.0, 1.0, 100.0)
}
