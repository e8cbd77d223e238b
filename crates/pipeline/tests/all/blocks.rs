//! A path in blocks of 64 revolutions is the path in one piece.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex};

use crate::common::solvers::{Area, Disjoint, Exact, Spline};
use crate::common::{Counting, K, Nodes, RIM, Saddle, Task, even, feed_of, inward, straight};
use turnpath_core::toolpath::PathBlock;
use turnpath_core::{
    Dependence, Direction, NodeList, Part, Path, Result, Revolutions, SamplerPlan, Scalar, Tool,
    Velocities, VelocitySolver,
};
use turnpath_verify::{FirstTouch, Meter, Subject};

/// The velocities of `solver` when it gets the whole path, of constant feed, at once.
fn whole(solver: &dyn VelocitySolver, path: &PathBlock, feed: f64, rpm: f64) -> [Vec<f64>; 3] {
    let count = path.len();
    let speed = rpm / 60.0 * TAU;
    let turned: Vec<(f64, f64)> = path.c.iter().map(|c| Scalar::sin_cos(2.0 * c)).collect();
    let at = |f: &dyn Fn(f64, f64, f64) -> f64| -> Vec<f64> {
        let points = path.x.iter().zip(&turned);
        points.map(|(x, (sin, cos))| f(*x, *sin, *cos)).collect()
    };
    let nodes = turnpath_core::Nodes {
        t: &path.t,
        c: &path.c,
        x: &path.x,
        z: &path.z,
        c_rate: &vec![speed; count],
        x_rate: &vec![feed / TAU * speed; count],
        z_theta: &at(&|x, _, cos| 2.0 * K * x * x * cos),
        z_x: &at(&|x, sin, _| 2.0 * K * x * sin),
        at_start: true,
        at_end: true,
    };
    let mut v = [vec![0.0; count], vec![0.0; count], vec![0.0; count]];
    let [c, x, z] = &mut v;
    solver
        .solve(nodes, Velocities { c, x, z })
        .expect("velocities");
    v
}

/// The largest difference between the path's velocities and those of `whole`, as a part of the
/// largest velocity of each axis.
fn difference(path: &PathBlock, whole: &[Vec<f64>; 3]) -> f64 {
    let columns = [&path.vc, &path.vx, &path.vz];
    let parts = columns.iter().zip(whole).map(|(column, whole)| {
        let scale = whole.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        let pairs = column.iter().zip(whole);
        pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / scale
    });
    parts.fold(0.0, f64::max)
}

/// Paths that end within, at and just after a block, and with a rest too small for a window.
const REVOLUTIONS: [f64; 7] = [0.3, 3.0, 64.0, 64.001, 65.0, 128.0, 200.3];

#[test]
fn a_spline_in_blocks_is_the_spline_of_the_whole_path() {
    for revolutions in REVOLUTIONS {
        let task = Task {
            feed: inward(revolutions),
            velocity: Arc::new(Spline { overlap: 64 }),
            ..Task::default()
        };
        let (path, _) = task.path();
        let whole = whole(&Spline { overlap: 64 }, &path, -RIM / revolutions, task.rpm);
        let difference = difference(&path, &whole);
        assert!(
            difference < 1e-12,
            "{revolutions} revolutions: {difference}"
        );
    }
}

/// What a solver is told of the ends of the nodes that it sees: the times of the first and of the last one,
/// and whether they are the path's ends.
type Ends = Arc<Mutex<Vec<([f64; 2], [bool; 2])>>>;

/// A solver that keeps what it is told.
struct EndsKeeper {
    dependence: Dependence,
    ends: Ends,
}

impl VelocitySolver for EndsKeeper {
    fn dependence(&self) -> Dependence {
        self.dependence
    }

    fn solve(&self, nodes: turnpath_core::Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        if let [first, .., last] = nodes.t {
            let ends = ([*first, *last], [nodes.at_start, nodes.at_end]);
            self.ends.lock().expect("the ends").push(ends);
        }
        Exact.solve(nodes, out)
    }
}

/// A path is made of blocks of 64 nodes together. A sample has blocks of 32, each of which is made alone.
/// The nodes that a solver sees of a neighbour are fewer, as many, and more.
#[test]
fn a_solver_is_told_of_the_ends_of_the_path_where_it_sees_them() {
    for overlap in [0, 1, 31, 32, 33, 64, 200] {
        for revolutions in [0.3, 63.0, 64.5, 193.0] {
            let ends = Ends::default();
            let task = Task {
                feed: inward(revolutions),
                sampler: even(1.0),
                refined: false,
                velocity: Arc::new(EndsKeeper {
                    dependence: match overlap {
                        0 => Dependence::Local,
                        _ => Dependence::Overlap(overlap),
                    },
                    ends: ends.clone(),
                }),
                ..Task::default()
            };
            let path = task.unmeasured();
            let [start, end] = [path.t[0], path.t[path.len() - 1]];
            task.sample();
            let ends = ends.lock().expect("the ends");
            for ([first, last], told) in ends.iter() {
                let seen = [*first == start, *last == end];
                assert_eq!(*told, seen, "{overlap}, {revolutions}: {first} to {last}");
            }
        }
    }
}

#[test]
fn an_overlap_may_reach_over_several_small_blocks() {
    // 16 nodes a block: 64 are four blocks.
    let task = Task {
        feed: inward(640.25),
        sampler: Arc::new(Nodes(|_: &Path<'_>, block: Revolutions| {
            let step = |i| block.start + 3.97 * f64::from(i);
            (0..16).map(step).take_while(|n| *n < block.end).collect()
        })),
        velocity: Arc::new(Spline { overlap: 64 }),
        ..Task::default()
    };
    let (path, _) = task.path();
    let whole = whole(&Spline { overlap: 64 }, &path, -RIM / 640.25, task.rpm);
    let difference = difference(&path, &whole);
    assert!(difference < 1e-12, "{difference}");
}

#[test]
fn a_sequential_solver_gets_its_state_in_order() {
    for revolutions in REVOLUTIONS {
        let task = Task {
            feed: inward(revolutions),
            velocity: Arc::new(Area),
            ..Task::default()
        };
        let (path, _) = task.path();
        let whole = whole(&Area, &path, -RIM / revolutions, task.rpm);
        let difference = difference(&path, &whole);
        assert!(
            difference < 1e-12,
            "{revolutions} revolutions: {difference}"
        );
    }
}

#[test]
fn a_sequential_sampler_gets_its_state_in_order() {
    let task = Task {
        sampler: Arc::new(Counting { step: 0.0377 }),
        velocity: Arc::new(Spline { overlap: 64 }),
        ..Task::default()
    };
    let (path, outcome) = task.path();
    assert_eq!(
        outcome.control_points,
        (200.0f64 / 0.0377).ceil() as u64 + 1
    );
    for (k, c) in path.c.iter().enumerate().take(path.len() - 1) {
        assert_eq!(*c, TAU * (k as f64 * 0.0377));
    }
}

#[test]
fn a_path_runs_from_end_to_end_without_a_point_too_many() {
    for revolutions in [
        0.3,
        1.0,
        64.0,
        64.0 + 1e-10,
        64.0 + 1e-6,
        64.5,
        128.0,
        130.0,
    ] {
        let task = Task {
            feed: inward(revolutions),
            ..Task::default()
        };
        let (path, outcome) = task.path();
        let last = path.get(path.len() - 1).unwrap();
        assert_eq!(path.get(0).unwrap().c, 0.0);
        assert_eq!(path.get(0).unwrap().x, RIM);
        assert_eq!(last.c, TAU * revolutions);
        assert!(last.x.abs() < 1e-12);
        assert_eq!(outcome.control_points, path.len() as u64);
        assert_eq!(outcome.added_by_refine, 0);
        let shortest = path.c.windows(2).map(|c| c[1] - c[0]).fold(9.0, f64::min);
        assert!(shortest > 1e-9, "{revolutions}: {shortest}");
        let expected = (revolutions * 36.0 - 1e-5).ceil() as usize + 1;
        let extra = path.len() - expected;
        assert!(extra == 0, "{revolutions}: {extra} more");
    }
}

#[test]
fn outward_runs_from_the_axis_to_the_rim() {
    let task = Task {
        feed: feed_of(vec![straight(100.0, 0.0, RIM / 100.0)]),
        direction: Direction::Outward,
        ..Task::default()
    };
    let (path, _) = task.path();
    assert_eq!((path.c[0], path.x[0]), (0.0, 0.0));
    assert!(path.x.windows(2).all(|x| x[1] > x[0]));
}

/// A sampler that goes through the path from its beginning. It has ten nodes on the first revolution, and 2000
/// on others.
#[derive(Clone, Default)]
struct Dense(Arc<Mutex<Vec<Revolutions>>>);

impl SamplerPlan for Dense {
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
        _: &mut Vec<f64>,
        nodes: &mut NodeList,
    ) -> Result<()> {
        self.0.lock().expect("no panic").push(block);
        for turn in block.turns() {
            nodes.extend(turn.subdivide(if turn.start < 1.0 { 10.0 } else { 2000.0 }));
        }
        Ok(())
    }
}

#[test]
fn blocks_are_short_where_a_sequential_sampler_is_dense_behind_the_first_revolution() {
    let sampler = Dense::default();
    let asked = sampler.0.clone();
    let task = Task {
        feed: inward(100.0),
        sampler: Arc::new(sampler),
        ..Task::default()
    };
    assert_eq!(task.unmeasured().len(), 99 * 2000 + 10 + 1);
    let asked = asked.lock().unwrap();
    // 50,000 nodes are comfortable. Threads ask for the blocks in any order.
    let of_length = |length: f64| {
        let blocks = asked.iter();
        let found = blocks.filter(move |block| block.end - block.start == length);
        let mut starts: Vec<f64> = found.map(|block| block.start).collect();
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        starts
    };
    assert_eq!(of_length(16.0), [0.0, 16.0, 32.0, 48.0, 64.0, 80.0]);
    assert_eq!(of_length(4.0), [96.0]);
    assert!(of_length(8.0).is_empty());
}

#[test]
fn at_a_knot_x_has_the_mean_of_both_rates() {
    // 0.02 mm a revolution to N = 70.3, then 0.03 mm.
    let (knot, x) = (70.3, RIM - 0.02 * 70.3);
    let task = Task {
        feed: feed_of(vec![
            straight(knot, RIM, -0.02),
            straight(x / 0.03, x, -0.03),
        ]),
        sampler: Arc::new(Nodes(|path: &Path<'_>, block: Revolutions| {
            let turns = block.turns().flat_map(|turn| turn.subdivide(36.0));
            let mut nodes: Vec<f64> = turns.collect();
            nodes.extend(path.law.knots(block.start, block.end));
            nodes.sort_by(f64::total_cmp);
            nodes
        })),
        ..Task::default()
    };
    let (path, _) = task.path();
    let at = path
        .c
        .iter()
        .position(|c| *c == TAU * knot)
        .expect("a node");
    for (k, rate) in [(at - 1, -0.02), (at, -0.025), (at + 1, -0.03)] {
        assert!((path.vx[k] - rate).abs() < 1e-12);
    }
}

fn assert_same_on_all_threads(task: &Task) {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("a pool");
        let (path, outcome) = pool.install(|| task.path());
        (path, format!("{outcome:?}"))
    };
    let alone = on(1);
    assert!(alone == on(4));
    assert!(alone == on(3));
}

#[test]
fn the_path_and_its_figures_are_the_same_on_any_number_of_threads() {
    assert_same_on_all_threads(&Task {
        feed: inward(500.0),
        sampler: even(11.0),
        velocity: Arc::new(Spline { overlap: 64 }),
        refined: true,
        interpolation: 1e-5,
        ..Task::default()
    });
    // With more threads more blocks are made at a time, and windows that disagree about their joint do not show it.
    assert_same_on_all_threads(&Task {
        feed: inward(1100.0),
        velocity: Arc::new(Disjoint),
        refined: true,
        interpolation: 1e-5,
        ..Task::default()
    });
}

#[test]
fn threads_ahead_of_the_path_place_each_block_once() {
    // The second tolerance makes the run refine, which asks for all nodes again.
    for interpolation in [1e-3, 1e-6] {
        let placed = Arc::new(Mutex::new(Vec::new()));
        let seen = placed.clone();
        let nodes = move |_: &Path<'_>, block: Revolutions| {
            seen.lock()
                .expect("no panic")
                .push([block.start, block.end]);
            block
                .turns()
                .flat_map(|turn| turn.subdivide(11.0))
                .collect()
        };
        let task = Task {
            feed: inward(1500.0),
            sampler: Arc::new(Nodes(nodes)),
            refined: true,
            interpolation,
            ..Task::default()
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build();
        pool.expect("a pool").install(|| task.path());
        let mut whole = placed.lock().expect("no panic").clone();
        whole.retain(|[start, end]| end - start > 1.0);
        whole.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let starts: Vec<f64> = whole.iter().map(|block| block[0]).collect();
        let once: Vec<f64> = (0..24).map(|index| 64.0 * f64::from(index)).collect();
        assert_eq!(starts, once, "{interpolation}");
    }
}

#[test]
fn a_node_just_after_the_start_is_the_start() {
    let task = Task {
        feed: inward(2.0),
        sampler: Arc::new(Nodes(|_: &Path<'_>, _: Revolutions| vec![1e-12, 0.5, 1.5])),
        velocity: Arc::new(Exact),
        ..Task::default()
    };
    let (path, outcome) = task.path();
    assert_eq!(path.c, [0.0, 0.5 * TAU, 1.5 * TAU, 2.0 * TAU]);
    assert_eq!(outcome.control_points, 4);
}

/// A sampler knows neither where the path ends nor the controller's steps of time. Its last node may be
/// closer to the end than a step.
#[test]
fn a_node_within_a_step_of_time_of_the_paths_end_is_the_end() {
    let steps = 4_096_000.0;
    for rpm in [433.0, 60.0, 977.0] {
        // A step is less than 4e-6 revolutions.
        for before in [1e-9, 1e-8, 1e-7, 1e-6] {
            let nodes = move |_: &Path<'_>, _: Revolutions| vec![0.0, 0.5, 1.5, 2.0 - before];
            let task = Task {
                feed: inward(2.0),
                rpm,
                time_steps: Some(steps),
                sampler: Arc::new(Nodes(nodes)),
                velocity: Arc::new(Exact),
                ..Task::default()
            };
            let (path, _) = task.path();
            assert!(path.len() == 4 || path.len() == 5, "{:?}", path.t);
            assert!(
                path.t.windows(2).all(|pair| pair[0] < pair[1]),
                "{:?}",
                path.t
            );
            let end = path.c[path.len() - 1] / TAU;
            assert!((2.0 - end).abs() <= rpm / 60.0 / steps, "{end}");
        }
    }
}

/// The largest error of a path of contacts, measured in one piece.
fn measured_whole(path: &PathBlock) -> f64 {
    let subject = Subject {
        surface: Arc::new(Saddle),
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
        compensates_nose: false,
    };
    let touch = FirstTouch::new(subject).expect("a surface");
    let measured = Meter::measure(&touch, path).expect("a measure");
    measured.playback.max()
}

#[test]
fn joints_are_measured_as_they_are_written_whatever_the_windows_have() {
    let task = Task {
        velocity: Arc::new(Disjoint),
        ..Task::default()
    };
    let (path, outcome) = task.path();
    let (here, whole) = (outcome.figures.playback.max(), measured_whole(&path));
    assert!((here - whole).abs() <= 1e-12 * whole, "{here}, not {whole}");
}

#[test]
fn control_points_lie_on_the_steps_of_the_controllers_time() {
    let steps = 4_096_000.0;
    let task = Task {
        rpm: 433.0,
        time_steps: Some(steps),
        sampler: even(37.0),
        ..Task::default()
    };
    let (path, outcome) = task.path();
    for (t, c) in path.t.iter().zip(&path.c) {
        assert_eq!((t * steps).round() / steps, *t);
        let spindle = t * 433.0 / 60.0 * TAU;
        assert!((c - spindle).abs() <= 1e-12 * spindle, "{c}, not {spindle}");
    }
    let (free, _) = Task {
        time_steps: None,
        ..task
    }
    .path();
    assert_eq!(path.len(), free.len());
    assert!(
        path.t
            .iter()
            .zip(&free.t)
            .all(|(a, b)| (a - b).abs() <= 1.0001 / steps)
    );
    assert_eq!(outcome.figures.playback.max(), measured_whole(&path));
}
