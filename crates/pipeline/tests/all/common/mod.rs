//! Small strategies, written straight to the core's traits, and a run of them.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

pub mod formulas;
pub mod solvers;

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::sync::Arc;

use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_core::{
    Centres, Compensator, Continuation, Cut, Dependence, Direction, FeedPiece, FeedPlan,
    FeedStrategy, JobSpec, Machine, NodeList, Overrun, Part, Path, Radial, Rates, Result,
    Revolutions, Sampler, SamplerPlan, Scalar, Setup, Slot, SpindleAsk, SpindleLaw,
    SpindleStrategy, StrategyError, Surface, SurfaceModel, Tolerance, Tool, VelocitySolver,
};
use turnpath_pipeline::{
    Chain, DraftSink, Estimate, LeadSettings, Link, Observer, Outcome, PathOptions, PathSample,
    PipelineError, RunError, SilentObserver, Sink, make_unmeasured, prepare, run, sample_path,
};
use turnpath_verify::FirstTouch;

/// The rim, mm.
pub const RIM: f64 = 2.0;
/// The tolerance of the residual, mm.
pub const RESIDUAL: f64 = 1e-4;
/// z = 2 K x y, mm.
pub const K: f64 = 0.02;

/// A weak saddle.
pub struct Saddle;

impl Surface for Saddle {
    const IN_WIDE_REGISTERS: bool = false;

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

/// A feed whose pieces come from a function, call by call.
pub struct Feed<F>(pub F);

struct Calls<F> {
    pieces: F,
    call: usize,
}

impl<F> FeedStrategy for Feed<F>
where
    F: Fn(usize) -> (Vec<FeedPiece>, Continuation) + Clone + Send + Sync + 'static,
{
    fn plan(&self, _: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let (pieces, call) = (self.0.clone(), 0);
        Ok(Box::new(Calls { pieces, call }))
    }
}

impl<F> FeedPlan for Calls<F>
where
    F: Fn(usize) -> (Vec<FeedPiece>, Continuation) + Send,
{
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let (more, onward) = (self.pieces)(self.call);
        self.call += 1;
        pieces.extend(more);
        Ok(onward)
    }
}

/// A piece of `length` revolutions from `start` on at a constant rate.
pub fn straight(length: f64, start: f64, rate: f64) -> FeedPiece {
    FeedPiece {
        length,
        coefficients: [start, rate, 0.0, 0.0, 0.0, 0.0],
    }
}

/// A feed inward from the rim to the axis in so many revolutions, in one piece.
pub fn inward(revolutions: f64) -> Arc<dyn FeedStrategy> {
    feed_of(vec![straight(revolutions, RIM, -RIM / revolutions)])
}

/// A feed with these pieces, in one call.
pub fn feed_of(pieces: Vec<FeedPiece>) -> Arc<dyn FeedStrategy> {
    Arc::new(Feed(move |_| (pieces.clone(), Continuation::End)))
}

/// A sampler whose nodes come from a function.
#[derive(Clone)]
pub struct Nodes<F>(pub F);

impl<F> SamplerPlan for Nodes<F>
where
    F: Fn(&Path<'_>, Revolutions) -> Vec<f64> + Send + Sync,
{
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        nodes.extend((self.0)(path, block));
        Ok(())
    }
}

/// A sampler whose nodes and offsets come from a function. It says that it needs exact rates.
pub struct NodesOff<F>(pub F);

impl<F> Sampler for NodesOff<F>
where
    F: Fn(&Path<'_>, Revolutions) -> NodeList + Clone + Send + Sync + 'static,
{
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(OffsetPlan(self.0.clone())))
    }

    fn needs_exact_rates(&self) -> bool {
        true
    }
}

struct OffsetPlan<F>(F);

impl<F> SamplerPlan for OffsetPlan<F>
where
    F: Fn(&Path<'_>, Revolutions) -> NodeList + Send + Sync,
{
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        nodes.append((self.0)(path, block));
        Ok(())
    }
}

/// A sampler with so many equal steps a revolution.
pub fn even(steps: f64) -> Arc<dyn Sampler> {
    Arc::new(Nodes(move |_: &Path<'_>, block: Revolutions| {
        let turns = block.turns();
        turns.flat_map(|turn| turn.subdivide(steps)).collect()
    }))
}

/// A sampler whose node k lies k steps from the start; `state` holds the next k.
#[derive(Clone)]
pub struct Counting {
    pub step: f64,
}

impl SamplerPlan for Counting {
    fn place(&self, _: &Path<'_>, _: Revolutions, _: &mut NodeList) -> Result<()> {
        panic!("a sequential sampler is asked in order");
    }

    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn place_sequential(
        &self,
        _: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut NodeList,
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

/// The speed that is asked for, all along the path.
pub struct Steady;

impl SpindleStrategy for Steady {
    fn plan(&self, _: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        Ok(SpindleLaw::constant(ask.speed))
    }
}

/// A task of small strategies. A test sets the fields that matter to it.
#[derive(Clone)]
pub struct Task {
    pub feed: Arc<dyn FeedStrategy>,
    pub sampler: Arc<dyn Sampler>,
    pub compensator: Arc<dyn Compensator>,
    pub velocity: Arc<dyn VelocitySolver>,
    pub spindle: Arc<dyn SpindleStrategy>,
    pub machine: Machine,
    pub direction: Direction,
    pub overrun: Overrun,
    pub interpolation: f64,
    pub rpm: f64,
    pub refined: bool,
    pub time_steps: Option<f64>,
    pub lead: Option<LeadSettings>,
}

impl Default for Task {
    fn default() -> Self {
        Self {
            feed: inward(200.0),
            sampler: even(36.0),
            compensator: Arc::new(Bare),
            velocity: Arc::new(solvers::Exact),
            spindle: Arc::new(Steady),
            machine: Machine::default(),
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

impl Task {
    /// The path and its outcome.
    pub fn run(&self) -> std::result::Result<(PathBlock, Outcome), Box<PipelineError>> {
        self.run_whole()
            .map(|(sink, outcome)| (sink.points, outcome))
    }

    /// The path with its sections, and its outcome.
    pub fn run_whole(&self) -> std::result::Result<(MemorySink, Outcome), Box<PipelineError>> {
        let mut sink = MemorySink::default();
        match self.run_into(&mut sink, &SilentObserver) {
            Ok(outcome) => Ok((sink, outcome)),
            Err(RunError::Pipeline(error)) => Err(Box::new(error)),
            Err(RunError::Sink(never)) => match never {},
        }
    }

    /// Gives the path to a sink while an observer watches.
    pub fn run_into<S: DraftSink>(
        &self,
        sink: &mut S,
        observer: &dyn Observer,
    ) -> std::result::Result<Outcome, RunError<S::Error>> {
        let chain = self.chain();
        let preparation = prepare(&chain.locus_links(), self.spec())?;
        run(&chain, &preparation, self.options(), sink, observer)
    }

    /// The path, made without measuring it.
    pub fn unmeasured(&self) -> PathBlock {
        let chain = self.chain();
        let preparation = prepare(&chain.locus_links(), self.spec()).expect("a tool that fits");
        let mut sink = MemorySink::default();
        make_unmeasured(
            &chain,
            &preparation,
            self.options(),
            &mut sink,
            &SilentObserver,
        )
        .expect("a path");
        sink.points
    }

    /// The estimate of the path, and a sample of it.
    pub fn sample(&self) -> (Estimate, PathSample) {
        let chain = self.chain();
        let preparation = prepare(&chain.locus_links(), self.spec()).expect("a tool that fits");
        sample_path(&chain, &preparation, self.options(), &SilentObserver).expect("a sample")
    }

    /// The first touch of the task's tool.
    pub fn touch(&self) -> FirstTouch {
        let preparation = prepare(&self.chain().locus_links(), self.spec());
        preparation.expect("a tool that fits").touch
    }

    fn chain(&self) -> Chain {
        let surface: Arc<dyn SurfaceModel> = Arc::new(Saddle);
        Chain {
            surface: link(Slot::Surface, surface),
            feed: link(Slot::Feed, self.feed.clone()),
            sampler: link(Slot::Sampler, self.sampler.clone()),
            compensator: link(Slot::Compensator, self.compensator.clone()),
            velocity: link(Slot::Velocity, self.velocity.clone()),
            spindle: link(Slot::Spindle, self.spindle.clone()),
        }
    }

    fn spec(&self) -> JobSpec {
        JobSpec {
            part: Part {
                aperture_radius: RIM,
                inner_radius: 0.0,
            },
            tool: Tool {
                nose_radius: 1.0,
                included_angle: None,
                clearance_angle: None,
                misfit: turnpath_core::Misfit::Refuse,
            },
            tolerance: Tolerance {
                interpolation: self.interpolation,
                residual: RESIDUAL,
            },
            overrun: self.overrun,
            direction: self.direction,
            spindle_speed: self.rpm / 60.0 * TAU,
            machine: self.machine,
        }
    }

    fn options(&self) -> PathOptions {
        PathOptions {
            refine: self.refined,
            time_steps: self.time_steps,
            lead: self.lead,
            covers_centre: false,
            form: None,
            servo: None,
            sketch: false,
        }
    }

    /// The path and its outcome of a task that works.
    pub fn path(&self) -> (PathBlock, Outcome) {
        self.run().expect("a path")
    }
}

/// A block of the path as its sink got it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delivery {
    pub section: Section,
    /// How many points it has.
    pub points: usize,
    /// How many points before it the sink was given.
    pub before: usize,
    pub opens_section: bool,
}

/// Keeps the path in memory.
#[derive(Default)]
pub struct MemorySink {
    /// All control points.
    pub points: PathBlock,
    /// The blocks in the order in which they came.
    pub deliveries: Vec<Delivery>,
}

impl MemorySink {
    /// Where the points of a section are.
    pub fn section(&self, section: Section) -> std::ops::Range<usize> {
        let count = |is_counted: &dyn Fn(Section) -> bool| -> usize {
            let deliveries = self.deliveries.iter();
            let counted = deliveries.filter(|delivery| is_counted(delivery.section));
            counted.map(|delivery| delivery.points).sum()
        };
        let before = count(&|s| s < section);
        before..before + count(&|s| s == section)
    }
}

impl Sink for MemorySink {
    type Block = (Delivery, PathBlock);
    type Error = Infallible;

    fn encode(&self, block: &SectionBlock<'_>) -> std::result::Result<Self::Block, Infallible> {
        let delivery = Delivery {
            section: block.section,
            points: block.points.len(),
            before: block.before.len(),
            opens_section: block.opens_section,
        };
        Ok((delivery, block.points.clone()))
    }

    fn take(&mut self, points: usize, block: Self::Block) -> std::result::Result<(), Infallible> {
        let (delivery, block) = block;
        assert_eq!(points, delivery.points);
        self.deliveries.push(delivery);
        block.points().for_each(|point| self.points.push(point));
        Ok(())
    }
}

impl DraftSink for MemorySink {
    fn drop_draft(&mut self) {
        *self = Self::default();
    }
}
