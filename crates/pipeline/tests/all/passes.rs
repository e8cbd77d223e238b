//! How often a run makes its path: once where the path holds as the sampler has it, and anew, as if the
//! first pass had never been, where a segment of it is to be halved.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::common::solvers::{Area, Exact, Spline};
use crate::common::{MemorySink, Task, even, inward};
use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_core::{
    Dependence, NodeList, Nodes, Path, Result, Revolutions, SamplerPlan, Velocities, VelocitySolver,
};
use turnpath_pipeline::{
    DraftSink, LeadLimits, LeadSettings, Observer, Outcome, PipelineError, RunError,
    SilentObserver, Sink, Stage,
};
use turnpath_verify::{BlockPlayback, Meter};

/// Revolutions of a path whose last blocks are not made together with the first.
const LONG: f64 = 4200.0;
/// When its last block but one begins, s: at a revolution a second, with blocks of 64.
const LATE: f64 = 4096.0;

/// Another solver, but Z is faster by `excess` from a time on. The cubics then err by 4/27 of the excess
/// and the step.
struct Hasty<S> {
    solver: S,
    /// s.
    from: f64,
    /// mm/s.
    excess: f64,
    calls: Arc<AtomicUsize>,
}

impl<S: VelocitySolver> Hasty<S> {
    fn new(solver: S, from: f64, excess: f64) -> Self {
        let calls = Arc::default();
        Self {
            solver,
            from,
            excess,
            calls,
        }
    }

    fn hasten(&self, times: &[f64], z: &mut [f64]) {
        self.calls.fetch_add(1, Ordering::SeqCst);
        for (t, z) in times.iter().zip(z) {
            if *t >= self.from {
                *z += self.excess;
            }
        }
    }
}

impl<S: VelocitySolver> VelocitySolver for Hasty<S> {
    fn dependence(&self) -> Dependence {
        self.solver.dependence()
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let times = nodes.t;
        let Velocities { c, x, z } = out;
        self.solver.solve(nodes, Velocities { c, x, z: &mut *z })?;
        self.hasten(times, z);
        Ok(())
    }

    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        let times = nodes.t;
        let Velocities { c, x, z } = out;
        let own = Velocities { c, x, z: &mut *z };
        self.solver.solve_sequential(nodes, state, own)?;
        self.hasten(times, z);
        Ok(())
    }
}

/// Lists the stages that begin.
#[derive(Default)]
struct Stages(Mutex<Vec<Stage>>);

impl Observer for Stages {
    fn begin(&self, stage: Stage, _: u64) {
        self.0.lock().unwrap().push(stage);
    }

    fn advance(&self, _: u64) {}
}

/// Keeps the path, and how many blocks it had when a draft was dropped.
#[derive(Default)]
struct DropList {
    path: MemorySink,
    dropped: Vec<usize>,
}

impl Sink for DropList {
    type Block = <MemorySink as Sink>::Block;
    type Error = <MemorySink as Sink>::Error;

    fn encode(&self, block: &SectionBlock<'_>) -> std::result::Result<Self::Block, Self::Error> {
        self.path.encode(block)
    }

    fn take(&mut self, points: usize, block: Self::Block) -> std::result::Result<(), Self::Error> {
        self.path.take(points, block)
    }
}

impl DraftSink for DropList {
    fn drop_draft(&mut self) {
        self.dropped.push(self.path.deliveries.len());
        self.path.drop_draft();
    }
}

/// A long path of some ten thousand points whose solver errs from a time on.
fn long<S: VelocitySolver + 'static>(solver: S, from: f64) -> Task {
    Task {
        feed: inward(LONG),
        sampler: even(8.0),
        velocity: Arc::new(Hasty::new(solver, from, 0.2)),
        interpolation: 2e-3,
        refined: true,
        ..Task::default()
    }
}

fn run(task: &Task) -> (DropList, Outcome, Vec<Stage>) {
    let (mut sink, stages) = (DropList::default(), Stages::default());
    let outcome = task.run_into(&mut sink, &stages).unwrap();
    (sink, outcome, stages.0.into_inner().unwrap())
}

fn bits(path: &PathBlock) -> Vec<[u64; 7]> {
    let numbers = path
        .points()
        .map(|p| [p.t, p.c, p.x, p.z, p.vc, p.vx, p.vz]);
    numbers.map(|point| point.map(f64::to_bits)).collect()
}

#[test]
fn a_path_that_holds_is_made_and_played_once() {
    let calls = |refined: bool| {
        let velocity = Hasty::new(Exact, f64::INFINITY, 0.0);
        let calls = velocity.calls.clone();
        let task = Task {
            velocity: Arc::new(velocity),
            feed: inward(200.0),
            refined,
            ..Task::default()
        };
        let (sink, outcome, stages) = run(&task);
        assert_eq!(stages, [Stage::Law, Stage::Write]);
        assert_eq!((sink.dropped.len(), outcome.added_by_refine), (0, 0));
        calls.load(Ordering::SeqCst)
    };
    // A block of 64 revolutions each time.
    assert_eq!([calls(false), calls(true)], [4, 4]);
}

/// Eight even steps a revolution, and the starts of the blocks for which they were asked.
#[derive(Clone, Default)]
struct BlockStarts(Arc<Mutex<Vec<u32>>>);

impl SamplerPlan for BlockStarts {
    fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        // The host asks for single revolutions before it knows how long its blocks are.
        if block.end - block.start > 1.0 {
            self.0.lock().unwrap().push(block.start as u32);
        }
        let steps = (8.0 * (block.end - block.start)).ceil() as u32;
        let places = (0..steps).map(|k| block.start + 0.125 * f64::from(k));
        places
            .filter(|n| *n < block.end)
            .for_each(|n| nodes.push(n));
        Ok(())
    }
}

/// Blocks of a batch need nodes of the batches before and behind.
#[test]
fn a_block_of_nodes_is_placed_once_with_and_without_refinement() {
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one_thread = one_thread.unwrap();
    for refined in [false, true] {
        let starts = BlockStarts::default();
        let task = Task {
            sampler: Arc::new(starts.clone()),
            velocity: Arc::new(Spline { overlap: 64 }),
            feed: inward(1280.0),
            refined,
            ..Task::default()
        };
        let (_, _, stages) = one_thread.install(|| run(&task));
        assert_eq!(stages.len() > 2, refined, "{stages:?}");
        let mut asked = starts.0.lock().unwrap().clone();
        asked.sort_unstable();
        let blocks: Vec<u32> = (0..20).map(|block| 64 * block).collect();
        assert_eq!(asked, blocks, "refined: {refined}");
    }
}

/// The figures of a path from its blocks, by a meter that sees them once.
fn figures(task: &Task, sink: &MemorySink) -> String {
    let touch = task.touch();
    let mut meter = Meter::new(touch.clone());
    let mut from = 0;
    for delivery in &sink.deliveries {
        assert_eq!(delivery.section, Section::Cutting);
        let to = from + delivery.points;
        let mut block = PathBlock::default();
        (from..=to)
            .filter_map(|index| sink.points.get(index))
            .for_each(|point| block.push(point));
        let offsets = vec![0.0; block.len()];
        let playback = BlockPlayback::of(&touch, &block).unwrap();
        let measured = Meter::measure_played(&touch, playback, &block, &offsets, false).unwrap();
        meter.append(measured).unwrap();
        from = to;
    }
    format!("{:?}", meter.figures().unwrap())
}

#[track_caller]
fn assert_refined_as_if_at_first(task: &Task, dropped: &[usize]) {
    let (sink, outcome, stages) = run(task);
    assert_eq!(sink.dropped, dropped);
    assert_eq!(
        stages[..4],
        [Stage::Law, Stage::Write, Stage::Refine(1), Stage::Refine(2)]
    );
    assert_eq!(stages.last(), Some(&Stage::Write));
    assert!(outcome.added_by_refine > 0);
    assert!(outcome.figures.playback.max() <= task.interpolation);
    // A path that is not measured is refined before any of it is given away.
    assert_eq!(bits(&sink.path.points), bits(&task.unmeasured()));
    let figures = figures(task, &sink.path);
    assert_eq!(figures, format!("{:?}", outcome.figures));
}

#[test]
fn what_was_written_is_dropped_where_the_last_block_is_to_be_refined() {
    // Of 64 blocks in a batch one waits for the first point of the next.
    assert_refined_as_if_at_first(&long(Exact, LATE), &[63]);
    assert_refined_as_if_at_first(&long(Spline { overlap: 64 }, LATE), &[63]);
}

#[test]
fn nothing_is_written_where_the_first_block_is_to_be_refined() {
    assert_refined_as_if_at_first(&long(Exact, 0.0), &[0]);
    let task = Task {
        feed: inward(100.0),
        ..long(Area, 0.0)
    };
    assert_refined_as_if_at_first(&task, &[0]);
}

#[test]
fn the_bytes_of_a_path_that_is_begun_twice_do_not_depend_on_threads() {
    let task = long(Exact, LATE);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let (sink, outcome, _) = pool.build().unwrap().install(|| run(&task));
        (bits(&sink.path.points), format!("{outcome:?}"))
    };
    let one = on(1);
    assert!(on(2) == one && on(4) == one);
}

/// The exact rates, but in the first second C stands still where a step begins that takes longer than
/// this, s.
struct SlowStart(f64);

impl VelocitySolver for SlowStart {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let times = nodes.t;
        let Velocities { c, x, z } = out;
        Exact.solve(nodes, Velocities { c: &mut *c, x, z })?;
        for (c, step) in c.iter_mut().zip(times.windows(2)) {
            if step[0] < 1.0 && step[1] - step[0] > self.0 {
                *c = 0.0;
            }
        }
        Ok(())
    }
}

/// No lead joins a cut at which C stands still.
#[test]
fn a_lead_in_that_refinement_makes_possible_is_made() {
    let lead = LeadSettings {
        clearance: 0.5,
        limits: LeadLimits::default(),
    };
    let task = |refined| Task {
        feed: inward(20.0),
        velocity: Arc::new(SlowStart(0.02)),
        lead: Some(lead),
        refined,
        ..Task::default()
    };
    match task(false).run().map_err(|error| *error) {
        Err(PipelineError::Lead { which, .. }) => assert_eq!(which, "lead-in"),
        other => panic!("{:?}", other.map(|(_, outcome)| outcome)),
    }
    let (path, outcome) = task(true).path();
    assert!(outcome.lead.is_some() && outcome.added_by_refine > 0);
    assert_eq!(bits(&path), bits(&task(true).unmeasured()));
}

/// Cannot carry blocks of so few points.
struct DenseOnly(usize);

impl Sink for DenseOnly {
    type Block = ();
    type Error = usize;

    fn encode(&self, block: &SectionBlock<'_>) -> std::result::Result<(), usize> {
        match block.points.len() {
            points if points < self.0 => Err(points),
            _ => Ok(()),
        }
    }

    fn take(&mut self, _: usize, (): ()) -> std::result::Result<(), usize> {
        Ok(())
    }
}

impl DraftSink for DenseOnly {
    fn drop_draft(&mut self) {}
}

/// A block of 64 revolutions of 8 points, which is refined or stays.
#[test]
fn a_block_that_a_sink_cannot_carry_fails_the_run_where_refinement_leaves_it_so() {
    let error = |from, least| {
        let task = Task {
            feed: inward(128.0),
            ..long(Exact, from)
        };
        task.run_into(&mut DenseOnly(least), &SilentObserver).err()
    };
    let never = f64::INFINITY;
    assert!(error(never, 512).is_none());
    assert!(matches!(error(never, 513), Some(RunError::Sink(512))));
    assert!(error(0.0, 513).is_none());
    // The first block stays.
    assert!(matches!(error(100.0, 513), Some(RunError::Sink(512))));
}
