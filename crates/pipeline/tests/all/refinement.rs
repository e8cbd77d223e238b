//! Refinement: the tolerance holds for every solver, or the outcome shows that it does not.

use std::sync::{Arc, Mutex};

use crate::common::solvers::{Area, Exact, Halting, Resting, Saying, Spline};
use crate::common::{Counting, K, Nodes, RESIDUAL, RIM, Task, even, feed_of, inward, straight};
use turnpath_core::{
    Centres, Compensator, Cut, Dependence, FeedPiece, Path, Radial, Result, Revolutions, Scalar,
    VelocitySolver,
};
use turnpath_pipeline::{MOST_ROUNDS, SMALLEST_SEGMENT};

fn refined(velocity: Arc<dyn VelocitySolver>, interpolation: f64) -> Task {
    Task {
        feed: inward(150.0),
        sampler: even(8.0),
        velocity,
        interpolation,
        refined: true,
        ..Task::default()
    }
}

#[test]
fn the_tolerance_holds_for_solvers_of_every_dependence() {
    let tolerance = 2e-6;
    let solvers: [Arc<dyn VelocitySolver>; 3] = [
        Arc::new(Exact),
        Arc::new(Spline { overlap: 64 }),
        Arc::new(Area),
    ];
    for velocity in solvers {
        let mut task = refined(velocity, tolerance);
        let (path, outcome) = task.path();
        assert!(outcome.figures.playback.max() <= tolerance);
        assert_eq!(outcome.control_points, path.len() as u64);
        task.refined = false;
        let (coarse, before) = task.path();
        assert!(before.figures.playback.max() > 100.0 * tolerance);
        assert_eq!(before.added_by_refine, 0);
        let added = (path.len() - coarse.len()) as u64;
        assert_eq!(outcome.added_by_refine, added);
    }
}

/// A round plays all of a path with a sequential solver, and with others the segments that see new nodes. With no
/// velocity of Z a segment is halved nine times, and its error is zero in the middle.
#[test]
fn playing_what_changed_halves_the_segments_that_playing_everything_halves() {
    let refined_by = |velocity: Arc<dyn VelocitySolver>, tolerance: f64| {
        let (path, outcome) = refined(velocity, tolerance).path();
        assert!(outcome.figures.playback.max() <= tolerance);
        assert!(outcome.added_by_refine > 1000);
        path
    };
    let everything = Dependence::Sequential;
    let exact = refined_by(Arc::new(Saying(Exact, everything)), 2e-6);
    assert!(exact == refined_by(Arc::new(Exact), 2e-6));
    assert!(exact == refined_by(Arc::new(Saying(Exact, Dependence::Overlap(1))), 2e-6));
    // From the sixth round on halvings spread, but not with a local solver.
    let resting = refined_by(Arc::new(Saying(Resting, everything)), 1e-4);
    assert!(resting == refined_by(Arc::new(Saying(Resting, Dependence::Overlap(1))), 1e-4));
}

/// The velocities of a spline change by rounding with nodes that lie farther away.
#[test]
fn a_spline_that_sees_more_nodes_is_halved_as_one_that_sees_some() {
    let nodes = |overlap: usize| {
        let (path, outcome) = refined(Arc::new(Spline { overlap }), 2e-6).path();
        assert!(outcome.added_by_refine > 1000);
        path.c
    };
    assert!(nodes(64) == nodes(5000));
}

#[test]
fn only_segments_beyond_the_tolerance_are_refined() {
    let (path, outcome) = refined(Arc::new(Exact), 2e-6).path();
    // The error grows with ρ²: steps are longer near the axis.
    let step = |i: usize| path.c[i + 1] - path.c[i];
    assert!(step(path.len() - 2) > 1.9 * step(0));
    let (_, finer) = refined(Arc::new(Exact), 1e-6).path();
    assert!(finer.control_points > outcome.control_points);
}

/// Besides the single turns that show how dense the nodes are.
#[test]
fn the_sampler_is_asked_once_for_each_block_however_many_passes_there_are() {
    let asked = Arc::new(Mutex::new(Vec::new()));
    let calls = asked.clone();
    let task = Task {
        sampler: Arc::new(Nodes(move |_: &Path<'_>, block: Revolutions| {
            calls.lock().unwrap().push([block.start, block.end]);
            block.turns().flat_map(|turn| turn.subdivide(8.0)).collect()
        })),
        ..refined(Arc::new(Exact), 2e-6)
    };
    assert!(task.path().1.added_by_refine > 0);
    let mut blocks = asked.lock().unwrap().clone();
    blocks.retain(|[start, end]| end - start > 1.0);
    blocks.sort_by(|one, other| one[0].total_cmp(&other[0]));
    assert_eq!(blocks, [[0.0, 64.0], [64.0, 128.0], [128.0, 150.0]]);
}

#[test]
fn without_need_nothing_is_added() {
    let (_, outcome) = refined(Arc::new(Exact), 1.0).path();
    assert_eq!(outcome.added_by_refine, 0);
}

#[test]
fn segments_stop_at_the_smallest_and_the_outcome_shows_the_missed_tolerance() {
    let tolerance = 1e-7;
    let task = Task {
        feed: inward(2.0),
        rpm: 500.0,
        ..refined(Arc::new(Resting), tolerance)
    };
    let (path, outcome) = task.path();
    let shortest = path.t.windows(2).map(|t| t[1] - t[0]).fold(1.0, f64::min);
    assert!((SMALLEST_SEGMENT..2.0 * SMALLEST_SEGMENT).contains(&shortest));
    let playback = &outcome.figures.playback;
    assert!(playback.max() > tolerance);
    assert!(playback.segment_time < 2.0 * SMALLEST_SEGMENT);
}

#[test]
fn rounds_end_and_the_outcome_shows_the_missed_tolerance() {
    let tolerance = 1e-9;
    let task = Task {
        feed: inward(0.25),
        rpm: 1.0,
        ..refined(Arc::new(Resting), tolerance)
    };
    let (_, outcome) = task.path();
    let halved = 1u64 << MOST_ROUNDS;
    assert_eq!(outcome.control_points, 2 * halved + 1);
    assert!(outcome.figures.playback.max() > tolerance);
}

/// X that halts at every point errs between points by 0.0962 of its step. With 8½ steps a turn two
/// neighbouring passes err in opposite ways. The error of Z does not count here.
fn halting(feed: f64, refined: bool) -> Task {
    Task {
        feed: inward(RIM / feed),
        sampler: Arc::new(Counting { step: STEP }),
        velocity: Arc::new(Halting),
        interpolation: 1.0,
        refined,
        ..Task::default()
    }
}

const STEP: f64 = 2.0 / 17.0;

#[test]
fn cusps_stay_below_the_residual_where_x_itself_errs_between_points() {
    let residual = |task: &Task| task.path().1.figures.residual.max / RESIDUAL;
    let planned = Task {
        velocity: Arc::new(Exact),
        ..halting(0.0275, false)
    };
    let (planned, coarse) = (residual(&planned), residual(&halting(0.0275, false)));
    let growth = 1.0 + 2.0 * 0.096_225 * STEP;
    // The saddle is steepest near the largest errors of X, not exactly there.
    assert!((coarse / planned - growth * growth).abs() < 2e-3);
    assert!(planned < 0.997 && coarse > 1.03, "{planned} {coarse}");
    let (path, outcome) = halting(0.0275, true).path();
    assert!(outcome.figures.residual.max <= 1.0006 * RESIDUAL);
    // Where the section is concave, cusps are lower and allow a larger error.
    let steps: Vec<f64> = path.c.windows(2).map(|c| c[1] - c[0]).collect();
    let longest = steps.iter().copied().fold(0.0, f64::max);
    let shortest = steps.iter().copied().fold(longest, f64::min);
    assert!(longest > 1.9 * shortest);
}

#[test]
fn cusps_that_come_from_the_law_add_no_points() {
    let (_, outcome) = halting(0.029, true).path();
    assert!(outcome.figures.residual.max > 1.05 * RESIDUAL);
    assert_eq!(outcome.added_by_refine, 0);
}

/// The contact path of a tool whose X goes to and fro within the turn.
struct Wobbling;

impl Compensator for Wobbling {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn compensates_nose(&self) -> bool {
        false
    }

    fn centre(&self, _: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        for (i, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            let sin = Scalar::sin(2.0 * theta);
            let x = rho - 0.06 + 0.05 * Scalar::cos(2.0 * theta);
            (out.x[i], out.foot[i]) = (x, x);
            out.z[i] = K * x * x * sin;
        }
        Ok(())
    }
}

#[test]
fn coinciding_passes_add_no_points() {
    const FEED: f64 = 0.01;
    // A turn along the rim. The next turn leaves it with the third power of the angle.
    let turn = 0.9999;
    let parting = [[RIM, 0.0, 0.0], [RIM - FEED, -FEED, 0.0]];
    let parting = FeedPiece::between(parting[0], parting[1], 2.0);
    let rest = RIM - FEED;
    let pieces = vec![
        straight(turn, RIM, 0.0),
        parting,
        straight(rest / FEED, rest, -FEED),
    ];
    let task = Task {
        feed: feed_of(pieces),
        compensator: Arc::new(Wobbling),
        interpolation: 1.0,
        refined: true,
        ..Task::default()
    };
    assert_eq!(task.path().1.added_by_refine, 0);
}
