//! Refinement: the tolerance holds for every solver, or the outcome says that it does not.

mod common;

use std::sync::Arc;

use common::solvers::{Area, Exact, Resting, Spline};
use common::{Job, even, inward};
use turnpath_core::VelocitySolver;
use turnpath_pipeline::{MOST_ROUNDS, SMALLEST_SEGMENT};

fn refined(velocity: Arc<dyn VelocitySolver>, interpolation: f64) -> Job {
    Job {
        feed: inward(150.0),
        sampler: even(8.0),
        velocity,
        interpolation,
        refined: true,
        ..Job::default()
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
        let mut job = refined(velocity, tolerance);
        let (path, outcome) = job.made();
        assert!(outcome.figures.playback.max() <= tolerance);
        assert_eq!(outcome.control_points, path.len() as u64);
        job.refined = false;
        let (coarse, before) = job.made();
        assert!(before.figures.playback.max() > 100.0 * tolerance);
        assert_eq!(before.added_by_refine, 0);
        let added = (path.len() - coarse.len()) as u64;
        assert_eq!(outcome.added_by_refine, added);
    }
}

#[test]
fn only_what_is_too_far_off_is_refined() {
    let (path, outcome) = refined(Arc::new(Exact), 2e-6).made();
    // The error grows with ρ²: steps are longer near the axis.
    let step = |i: usize| path.c[i + 1] - path.c[i];
    assert!(step(path.len() - 2) > 1.9 * step(0));
    let (_, finer) = refined(Arc::new(Exact), 1e-6).made();
    assert!(finer.control_points > outcome.control_points);
}

#[test]
fn without_need_nothing_is_added() {
    let (_, outcome) = refined(Arc::new(Exact), 1.0).made();
    assert_eq!(outcome.added_by_refine, 0);
}

#[test]
fn segments_end_at_the_smallest_and_the_outcome_says_that_it_is_not_enough() {
    let tolerance = 1e-7;
    let job = Job {
        feed: inward(2.0),
        rpm: 500.0,
        ..refined(Arc::new(Resting), tolerance)
    };
    let (path, outcome) = job.made();
    let shortest = path.t.windows(2).map(|t| t[1] - t[0]).fold(1.0, f64::min);
    assert!((SMALLEST_SEGMENT..2.0 * SMALLEST_SEGMENT).contains(&shortest));
    assert!(outcome.figures.playback.max() > tolerance);
}

#[test]
fn rounds_end_and_the_outcome_says_that_it_is_not_enough() {
    let tolerance = 1e-9;
    let job = Job {
        feed: inward(0.25),
        rpm: 1.0,
        ..refined(Arc::new(Resting), tolerance)
    };
    let (_, outcome) = job.made();
    let halved = 1u64 << MOST_ROUNDS;
    assert_eq!(outcome.control_points, 2 * halved + 1);
    assert!(outcome.figures.playback.max() > tolerance);
}
