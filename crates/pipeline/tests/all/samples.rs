//! What `check` asks of strategies for the sample of a path.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::common::solvers::{Exact, Spline};
use crate::common::{Task, even, inward};
use turnpath_core::{
    Dependence, NodeList, Nodes, Path, Result, Revolutions, SamplerPlan, Velocities, VelocitySolver,
};

/// Revolutions of the path. A block of the sample is one of them.
const TURNS: f64 = 1280.0;
/// Steps on each.
const STEPS: f64 = 40.0;
/// Blocks of a sample.
const SAMPLED: usize = 16;
/// Nodes that a spline sees on either side.
const OVERLAP: usize = 64;

/// Even steps, and how often they were asked for.
#[derive(Clone, Default)]
struct Counted(Arc<AtomicUsize>);

impl SamplerPlan for Counted {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        self.0.fetch_add(1, Ordering::SeqCst);
        let plan = even(STEPS).plan(path)?;
        plan.place(path, block, nodes)
    }
}

/// The times of the nodes that a solver was shown, call by call.
type Windows = Arc<Mutex<Vec<Vec<f64>>>>;

/// A spline that is watched. Z is too fast from a time on, s.
struct Watched {
    windows: Windows,
    hastes_from: f64,
}

impl Watched {
    fn from(hastes_from: f64) -> (Self, Windows) {
        let windows = Windows::default();
        let solver = Self {
            windows: windows.clone(),
            hastes_from,
        };
        (solver, windows)
    }
}

impl VelocitySolver for Watched {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(OVERLAP)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        self.windows.lock().unwrap().push(nodes.t.to_vec());
        let times = nodes.t;
        let Velocities { c, x, z } = out;
        let own = Velocities { c, x, z: &mut *z };
        Spline { overlap: OVERLAP }.solve(nodes, own)?;
        let late = times.iter().zip(z).filter(|(t, _)| **t >= self.hastes_from);
        late.for_each(|(_, z)| *z += 2.0);
        Ok(())
    }
}

fn task(velocity: impl VelocitySolver + 'static, refined: bool) -> Task {
    Task {
        feed: inward(TURNS),
        sampler: even(STEPS),
        velocity: Arc::new(velocity),
        interpolation: 1e-3,
        refined,
        ..Task::default()
    }
}

#[test]
fn the_sampler_is_asked_for_the_blocks_of_the_sample_alone() {
    let counted = Counted::default();
    let (solver, _) = Watched::from(f64::INFINITY);
    let task = Task {
        sampler: Arc::new(counted.clone()),
        ..task(solver, true)
    };
    let (estimate, sample) = task.sample();
    assert_eq!(sample.blocks.len(), SAMPLED);
    // The host looks at three revolutions before it knows how long its blocks are.
    assert_eq!(counted.0.load(Ordering::SeqCst), SAMPLED + 3);
    assert!((estimate.control_points / (TURNS * STEPS) - 1.0).abs() < 1e-4);
}

/// Nodes that are even on the path are even in each window, over all borders of blocks.
#[test]
fn a_solver_sees_its_overlap_on_either_side_of_a_block_of_the_sample() {
    let (solver, windows) = Watched::from(f64::INFINITY);
    let (_, sample) = task(solver, false).sample();
    let mut windows = windows.lock().unwrap().clone();
    assert_eq!(windows.len(), SAMPLED);
    // Threads come in any order.
    windows.sort_by(|one, other| one[0].total_cmp(&other[0]));
    for (window, block) in windows.iter().zip(&sample.blocks) {
        for pair in window.windows(2) {
            assert!((pair[1] - pair[0] - 1.0 / STEPS).abs() < 1e-9, "{pair:?}");
        }
        let [first, last] = [window.first(), window.last()].map(|t| *t.unwrap());
        let [from, to] = [block.points.t.first(), block.points.t.last()].map(|t| *t.unwrap());
        let overlap = OVERLAP as f64 / STEPS;
        assert!(first <= (from - overlap).max(0.0) + 1e-9, "{first} {from}");
        assert!(last >= (to + overlap).min(TURNS) - 1e-9, "{last} {to}");
    }
}

/// The blocks of a sample lie too far apart to see each other's nodes.
#[test]
fn where_one_block_of_the_sample_is_refined_the_others_are_not_played_again() {
    let (solver, windows) = Watched::from(TURNS - 0.5);
    let (_, sample) = task(solver, true).sample();
    let last = sample.blocks.last().unwrap();
    assert!(last.points.len() as f64 > STEPS + 1.0);
    let windows = windows.lock().unwrap();
    let middle = |window: &&Vec<f64>| window.last().is_some_and(|t| *t < TURNS - 10.0);
    // Once for refinement, and once for the sample.
    assert_eq!(windows.iter().filter(middle).count(), 2 * (SAMPLED - 1));
    assert!(windows.len() > 2 * SAMPLED);
}

#[test]
fn a_solver_without_overlap_has_the_same_estimate() {
    let (solver, _) = Watched::from(f64::INFINITY);
    let points = |task: Task| task.sample().0.control_points;
    assert_eq!(points(task(solver, true)), points(task(Exact, true)));
}
