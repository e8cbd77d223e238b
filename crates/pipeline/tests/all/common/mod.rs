//! Small strategies, written straight to the core's traits, and a run of them.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

pub mod solvers;

use std::f64::consts::TAU;
use std::io;
use std::sync::Arc;

use turnpath_core::toolpath::{PathBlock, PathStretch, Section};
use turnpath_core::{
    Centres, Compensator, Cut, Dependence, Direction, FeedPlan, FeedStrategy, Machine, Onward,
    Overrun, Part, Path, Radial, Rates, Result, Revolutions, Sampler, Scalar, Setup, Slot,
    SpindleLaw, StrategyError, Stretch, Surface, SurfaceModel, Tolerance, Tool, VelocitySolver,
};
use turnpath_pipeline::{
    Chain, LeadSettings, Link, Making, Outcome, PipelineError, Quiet, Sink, Wanted, prepare, run,
};

/// The rim, mm.
pub const RIM: f64 = 2.0;
/// The highest cusp that is allowed, mm.
pub const RESIDUAL: f64 = 1e-4;
/// z = 2 K x y, mm.
pub const K: f64 = 0.02;

/// A weak saddle.
pub struct Saddle;

impl Surface for Saddle {
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * y * (2.0 * K)
    }
}

/// The path of a point on the surface itself.
pub struct Bare;

impl Compensator for Bare {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn compensates_nose(&self) -> bool {
        false
    }

    fn centre(&self, _: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        for (i, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            (out.x[i], out.foot[i]) = (*rho, *rho);
            out.z[i] = K * rho * rho * Scalar::sin(2.0 * theta);
        }
        Ok(())
    }

    fn exact_rates(
        &self,
        _: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        for (i, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            let (sin, cos) = Scalar::sin_cos(2.0 * theta);
            (out.x_theta[i], out.x_rho[i]) = (0.0, 1.0);
            (out.z_theta[i], out.z_x[i]) = (2.0 * K * rho * rho * cos, 2.0 * K * rho * sin);
        }
        Some(Ok(()))
    }
}

/// A compensator whose centre is `value` beyond 90 degrees.
pub struct BrokenBeyond90(pub f64);

impl Compensator for BrokenBeyond90 {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let Centres { x, z, foot } = out;
        let all = Centres {
            x: &mut *x,
            z: &mut *z,
            foot,
        };
        Bare.centre(cut, theta, rho, all)?;
        for (theta, z) in theta.iter().zip(z) {
            if *theta > 0.25 * TAU {
                *z = self.0;
            }
        }
        Ok(())
    }

    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        Bare.exact_rates(cut, theta, rho, out)
    }
}

/// A feed whose pieces a function gives, call by call.
pub struct Feed<F>(pub F);

struct Calls<F> {
    pieces: F,
    call: usize,
}

impl<F> FeedStrategy for Feed<F>
where
    F: Fn(usize) -> (Vec<Stretch>, Onward) + Clone + Send + Sync + 'static,
{
    fn plan(&self, _: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let (pieces, call) = (self.0.clone(), 0);
        Ok(Box::new(Calls { pieces, call }))
    }
}

impl<F> FeedPlan for Calls<F>
where
    F: Fn(usize) -> (Vec<Stretch>, Onward) + Send,
{
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<Stretch>) -> Result<Onward> {
        let (more, onward) = (self.pieces)(self.call);
        self.call += 1;
        pieces.extend(more);
        Ok(onward)
    }
}

/// A piece of `length` revolutions from `start` on at a constant rate.
pub fn straight(length: f64, start: f64, rate: f64) -> Stretch {
    Stretch {
        length,
        coefficients: [start, rate, 0.0, 0.0, 0.0, 0.0],
    }
}

/// Inward from the rim to the axis in so many revolutions, in one piece.
pub fn inward(revolutions: f64) -> Arc<dyn FeedStrategy> {
    feed_of(vec![straight(revolutions, RIM, -RIM / revolutions)])
}

/// These pieces, in one call.
pub fn feed_of(pieces: Vec<Stretch>) -> Arc<dyn FeedStrategy> {
    Arc::new(Feed(move |_| (pieces.clone(), Onward::Done)))
}

/// A sampler whose nodes a function gives.
pub struct Nodes<F>(pub F);

impl<F> Sampler for Nodes<F>
where
    F: Fn(&Path<'_>, Revolutions) -> Vec<f64> + Send + Sync,
{
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut Vec<f64>) -> Result<()> {
        nodes.extend((self.0)(path, block));
        Ok(())
    }
}

/// So many equal steps a revolution.
pub fn even(steps: f64) -> Arc<dyn Sampler> {
    Arc::new(Nodes(move |_: &Path<'_>, block: Revolutions| {
        let turns = block.turns();
        turns.flat_map(|turn| turn.subdivide(steps)).collect()
    }))
}

/// Node k lies at k steps from the start; `state` holds the next k.
pub struct Counting {
    pub step: f64,
}

impl Sampler for Counting {
    fn place(&self, _: &Path<'_>, _: Revolutions, _: &mut Vec<f64>) -> Result<()> {
        panic!("a sequential sampler is asked in order");
    }

    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn place_onward(
        &self,
        _: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut Vec<f64>,
    ) -> Result<()> {
        if state.is_empty() != (block.start == 0.0) {
            let what = format!("a state of {} at {}", state.len(), block.start);
            return Err(StrategyError::failed(what));
        }
        let mut k = state.first().copied().unwrap_or(0.0);
        while k * self.step < block.end {
            nodes.push(k * self.step);
            k += 1.0;
        }
        *state = vec![k];
        Ok(())
    }
}

/// A job of small strategies; what a test does not set stays usual.
pub struct Job {
    pub feed: Arc<dyn FeedStrategy>,
    pub sampler: Arc<dyn Sampler>,
    pub compensator: Arc<dyn Compensator>,
    pub velocity: Arc<dyn VelocitySolver>,
    pub direction: Direction,
    pub overrun: Overrun,
    pub interpolation: f64,
    pub rpm: f64,
    pub refined: bool,
    pub time_steps: Option<f64>,
    pub lead: Option<LeadSettings>,
}

impl Default for Job {
    fn default() -> Self {
        Self {
            feed: inward(200.0),
            sampler: even(36.0),
            compensator: Arc::new(Bare),
            velocity: Arc::new(solvers::Exact),
            direction: Direction::Inward,
            overrun: Overrun::None,
            interpolation: 1e-4,
            rpm: 60.0,
            refined: false,
            time_steps: None,
            lead: None,
        }
    }
}

fn link<T: ?Sized>(slot: Slot, strategy: Arc<T>) -> Link<T> {
    let (name, plugin) = ("mine".to_owned(), "a test".to_owned());
    Link {
        slot,
        name,
        plugin,
        strategy,
    }
}

impl Job {
    /// The path and its outcome.
    pub fn run(&self) -> std::result::Result<(PathBlock, Outcome), Box<PipelineError>> {
        self.run_whole()
            .map(|(kept, outcome)| (kept.points, outcome))
    }

    /// The path with its sections, and its outcome.
    pub fn run_whole(&self) -> std::result::Result<(Kept, Outcome), Box<PipelineError>> {
        let surface: Arc<dyn SurfaceModel> = Arc::new(Saddle);
        let chain = Chain {
            surface: link(Slot::Surface, surface),
            feed: link(Slot::Feed, self.feed.clone()),
            sampler: link(Slot::Sampler, self.sampler.clone()),
            compensator: link(Slot::Compensator, self.compensator.clone()),
            velocity: link(Slot::Velocity, self.velocity.clone()),
        };
        let part = Part {
            aperture_radius: RIM,
            inner_radius: 0.0,
        };
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: turnpath_core::Misfit::Refuse,
        };
        let tolerance = Tolerance {
            interpolation: self.interpolation,
            residual: RESIDUAL,
        };
        let wanted = Wanted {
            part,
            tool,
            tolerance,
            overrun: self.overrun,
            direction: self.direction,
            spindle: SpindleLaw::constant(self.rpm / 60.0 * TAU),
            machine: Machine::default(),
        };
        let prepared = prepare(&chain, wanted)?;
        let mut kept = Kept::default();
        let making = Making {
            refine: self.refined,
            time_steps: self.time_steps,
            lead: self.lead,
            covers_centre: false,
            servo: None,
        };
        let outcome = run(&chain, &prepared, making, &mut kept, &Quiet)?;
        Ok((kept, outcome))
    }

    /// The path and its outcome of a job that works.
    pub fn made(&self) -> (PathBlock, Outcome) {
        self.run().expect("a path")
    }
}

/// Keeps the path.
#[derive(Default)]
pub struct Kept {
    /// All control points.
    pub points: PathBlock,
    /// What each stretch was told: its section, its points, those before it, and whether it opens
    /// its section.
    pub stretches: Vec<(Section, usize, usize, bool)>,
}

impl Kept {
    /// Where the points of a section are.
    pub fn section(&self, section: Section) -> std::ops::Range<usize> {
        let count = |wanted: &dyn Fn(Section) -> bool| -> usize {
            let stretches = self.stretches.iter();
            let chosen = stretches.filter(|stretch| wanted(stretch.0));
            chosen.map(|stretch| stretch.1).sum()
        };
        let before = count(&|s| s < section);
        before..before + count(&|s| s == section)
    }
}

impl Sink for Kept {
    fn encode(&self, stretch: &PathStretch<'_>) -> io::Result<Vec<Vec<u8>>> {
        let numbers = stretch
            .points
            .points()
            .flat_map(|p| [p.t, p.c, p.x, p.z, p.vc, p.vx, p.vz]);
        let told = [
            stretch.section as u8,
            stretch.before.len() as u8,
            u8::from(stretch.opens_section),
        ];
        Ok(vec![
            told.to_vec(),
            numbers.flat_map(f64::to_le_bytes).collect(),
        ])
    }

    fn take(&mut self, points: usize, encoded: &[Vec<u8>]) -> io::Result<()> {
        let (told, encoded) = (&encoded[0], &encoded[1]);
        let section = [Section::LeadIn, Section::Cutting, Section::LeadOut][usize::from(told[0])];
        self.stretches
            .push((section, points, usize::from(told[1]), told[2] == 1));
        let (bytes, _) = encoded.as_chunks::<8>();
        let numbers: Vec<f64> = bytes.iter().map(|b| f64::from_le_bytes(*b)).collect();
        for [t, c, x, z, vc, vx, vz] in numbers.as_chunks::<7>().0 {
            self.points.push(turnpath_core::toolpath::ControlPoint {
                t: *t,
                c: *c,
                x: *x,
                z: *z,
                vc: *vc,
                vx: *vx,
                vz: *vz,
            });
        }
        Ok(())
    }
}
