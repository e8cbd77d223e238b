//! What `check` asks of strategies for the sample of a path.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::common::solvers::{Exact, Spline};
use crate::common::{Counting, Nodes as EvenNodes, Task, even, inward};
use turnpath_core::{
    Dependence, NodeList, Nodes, Path, Result, Revolutions, Sampler, SamplerPlan, Velocities,
    VelocitySolver,
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

/// Even steps that do not begin afresh at whole revolutions.
fn in_steps_of(length: f64) -> Arc<dyn Sampler> {
    Arc::new(EvenNodes(move |_: &Path<'_>, block: Revolutions| {
        let first = (block.start / length).ceil() as u32;
        let nodes = (first..).map(|k| f64::from(k) * length);
        nodes.take_while(|n| *n < block.end).collect()
    }))
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
fn the_sampler_is_asked_for_the_blocks_of_the_sample_and_for_two_more() {
    for turns in [TURNS, TURNS + 0.4] {
        let counted = Counted::default();
        let (solver, _) = Watched::from(f64::INFINITY);
        let task = Task {
            sampler: Arc::new(counted.clone()),
            feed: inward(turns),
            ..task(solver, true)
        };
        let (estimate, sample) = task.sample();
        assert_eq!(sample.blocks.len(), SAMPLED);
        // The neighbours of the first and of the last block stand in for them, and the host looks at three
        // revolutions before it knows how long its blocks are.
        assert_eq!(counted.0.load(Ordering::SeqCst), SAMPLED + 2 + 3);
        let ratio = estimate.control_points / (turns * STEPS);
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    }
}

#[track_caller]
fn assert_sees_even_steps(turns: f64, sampler: Arc<dyn Sampler>, step: f64) {
    let (solver, windows) = Watched::from(f64::INFINITY);
    let task = Task {
        feed: inward(turns),
        sampler,
        ..task(solver, false)
    };
    let (estimate, sample) = task.sample();
    let ratio = estimate.control_points * step / turns;
    assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
    let mut windows = windows.lock().unwrap().clone();
    assert_eq!(windows.len(), SAMPLED);
    // Threads come in any order.
    windows.sort_by(|one, other| one[0].total_cmp(&other[0]));
    for (window, block) in windows.iter().zip(&sample.blocks) {
        let last = window.len() - 2;
        for (k, pair) in window.windows(2).enumerate() {
            let off = pair[1] - pair[0] - step;
            // The path's last step is what is left.
            let is_rest = k == last && pair[1] == turns && off < 0.0;
            assert!(is_rest || off.abs() < 1e-9, "{pair:?}");
        }
        let [first, last] = [window.first(), window.last()].map(|t| *t.unwrap());
        let [from, to] = [block.points.t.first(), block.points.t.last()].map(|t| *t.unwrap());
        let overlap = OVERLAP as f64 * step;
        assert!(first <= (from - overlap).max(0.0) + 1e-9, "{first} {from}");
        assert!(last >= (to + overlap).min(turns) - 1e-9, "{last} {to}");
    }
}

/// Nodes that are even on the path are even in each window, over all borders of blocks.
#[test]
fn a_solver_sees_its_overlap_on_either_side_of_a_block_of_the_sample() {
    assert_sees_even_steps(TURNS, even(STEPS), 1.0 / STEPS);
    assert_sees_even_steps(TURNS + 0.4, even(STEPS), 1.0 / STEPS);
    // Blocks of several revolutions.
    assert_sees_even_steps(TURNS, even(9.0), 1.0 / 9.0);
    assert_sees_even_steps(TURNS, in_steps_of(0.0247), 0.0247);
    assert_sees_even_steps(TURNS + 0.4, in_steps_of(0.0247), 0.0247);
    // Every seventh revolution begins with a node by chance.
    assert_sees_even_steps(TURNS, in_steps_of(7.0 / 280.0 * 1.01), 7.0 / 280.0 * 1.01);
    assert_sees_even_steps(TURNS, in_steps_of(7.0 / 270.0), 7.0 / 270.0);
}

/// Where all segments are halved, a solver sees none that are longer beyond a block. The blocks beside the
/// first and the last one are not of the sample, so that these two see longer ones.
#[test]
fn what_lies_beyond_a_block_of_the_sample_is_halved_as_the_block_is() {
    for sampler in [even(STEPS), in_steps_of(0.0247)] {
        let (solver, windows) = Watched::from(0.0);
        let task = Task {
            sampler,
            ..task(solver, true)
        };
        task.sample();
        let windows = windows.lock().unwrap();
        let is_inner =
            |window: &&Vec<f64>| window[0] > 3.0 && window[window.len() - 1] < TURNS - 3.0;
        let mut halved = 0;
        for window in windows.iter().filter(is_inner) {
            let steps = || window.windows(2).map(|pair| pair[1] - pair[0]);
            let [shortest, longest] = [
                steps().fold(f64::INFINITY, f64::min),
                steps().fold(0.0, f64::max),
            ];
            assert!(longest < 1.01 * shortest, "{shortest} {longest}");
            halved += usize::from(longest < 0.9 / STEPS);
        }
        assert!(halved >= SAMPLED - 2, "{halved}");
    }
}

/// It has run over the path before, and has its nodes where they are.
#[test]
fn a_sampler_that_is_asked_in_order_has_its_own_nodes() {
    let (solver, _) = Watched::from(f64::INFINITY);
    let task = Task {
        sampler: Arc::new(Counting { step: 1.0 / 40.5 }),
        ..task(solver, true)
    };
    let ratio = task.sample().0.control_points / (TURNS * 40.5);
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
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

/// A solver whose Z wanders further off its rate from node to node, along the whole path.
struct Wandering;

impl VelocitySolver for Wandering {
    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        self.solve_sequential(nodes, &mut Vec::new(), out)
    }

    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        let Velocities { c, x, z } = out;
        let mut off = state.first().copied().unwrap_or(0.0);
        Exact.solve(nodes, Velocities { c, x, z: &mut *z })?;
        let last = z.len() - 1;
        for (k, z) in z.iter_mut().enumerate() {
            *z += off;
            // The last node is the next block's first.
            off += if k < last { 2e-5 } else { 0.0 };
        }
        *state = vec![off];
        Ok(())
    }
}

/// What refinement adds follows from the whole path before.
#[test]
fn the_estimate_of_a_solver_that_goes_through_the_path_is_its_path() {
    let task = task(Wandering, true);
    let added = task.path().1.added_by_refine as f64;
    let nodes = TURNS * STEPS;
    assert!(added > 0.2 * nodes && added < 5.0 * nodes, "{added}");
    let ratio = task.sample().0.control_points / (nodes + added);
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

#[test]
fn a_solver_without_overlap_has_the_same_estimate() {
    let (solver, _) = Watched::from(f64::INFINITY);
    let points = |task: Task| task.sample().0.control_points;
    assert_eq!(points(task(solver, true)), points(task(Exact, true)));
}
