//! Nodes off the locus: a segment may use the tolerance on both sides, halving keeps its ends where
//! they are, and a moved node keeps its offset.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{K, NodesOff, RIM, Task, even};
use turnpath_core::toolpath::ControlPoint;
use turnpath_core::{NodeList, NodeOffset, Path, Revolutions, Sampler, Scalar, angle};

/// A step, rad.
const STEP: f64 = 10.0 * TAU / 360.0;

/// The error of a cubic with exact ends over one step around 45°, mm: h⁴/384·φ⁗ with
/// φ = K ρ² sin 2θ.
fn exact_ends(rho: f64) -> f64 {
    Scalar::powi(STEP, 4) / 384.0 * 16.0 * K * rho * rho
}

/// Which nodes of [`long_segments`] lie off the locus.
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    /// Both ends of each long segment.
    Both,
    /// The first end only.
    First,
}

/// Nodes every 2.5°, but none within 40° to 50°: that segment is four times as long as the others. At
/// its ends Z has three times the error of exact ends as a slope over the step, so that its own
/// error falls to a quarter: −16 M u² + 3 M u with u = s(1 − s).
fn long_segments(ends: Ends) -> Arc<dyn Sampler> {
    Arc::new(NodesOff(move |path: &Path<'_>, block: Revolutions| {
        let mut nodes = NodeList::default();
        for turn in block.turns() {
            for (i, n) in turn.subdivide(144.0).enumerate() {
                let slope = 3.0 * exact_ends(path.radius_at(n)) / STEP;
                let offset = |dz_dc| NodeOffset { dz: 0.0, dz_dc };
                match i {
                    16 => nodes.push_off(n, offset(slope)),
                    17..20 => {}
                    20 if ends == Ends::Both => nodes.push_off(n, offset(-slope)),
                    _ => nodes.push(n),
                }
            }
        }
        nodes
    }))
}

fn largest_error(sampler: Arc<dyn Sampler>) -> f64 {
    let task = Task {
        sampler,
        ..Task::default()
    };
    let (_, outcome) = task.path();
    assert!(outcome.figures.points.max() < 1e-12);
    outcome.figures.playback.max()
}

/// The largest amount of a function over 0 to 1.
fn largest(error: impl Fn(f64) -> f64) -> f64 {
    let amount = |i: u32| error(f64::from(i) / 1000.0).abs();
    (0..=1000).map(amount).fold(0.0, f64::max)
}

/// A halving that dropped the offset of an end would leave the segment beside it with one end only:
/// 2.6 times the error of both.
#[test]
fn with_both_offsets_a_segment_holds_a_quarter_and_with_one_dropped_two_and_a_half_times_that() {
    let whole = exact_ends(RIM);
    let u = |s: f64| s * (1.0 - s);
    let both = largest(|s| 16.0 * u(s) * u(s) - 3.0 * u(s));
    let first = largest(|s| 16.0 * u(s) * u(s) - 3.0 * u(s) * (1.0 - s));
    assert!((both - 0.25).abs() < 1e-6 && (first / both - 2.6).abs() < 0.02);
    for (ends, expected) in [(Ends::Both, both), (Ends::First, first)] {
        let found = largest_error(long_segments(ends));
        let part = found / whole / expected;
        assert!((part - 1.0).abs() < 0.03, "{part}");
    }
}

/// Z and vZ of a point off the locus, from the surface itself: Z = K X² sin 2C, and X is ρ here.
fn above_locus(point: &ControlPoint) -> f64 {
    point.z - K * point.x * point.x * Scalar::sin(2.0 * point.c)
}

/// Equal steps, each node with an offset of its own.
fn uneven(steps: f64) -> Arc<dyn Sampler> {
    Arc::new(NodesOff(move |path: &Path<'_>, block: Revolutions| {
        let mut nodes = NodeList::default();
        for n in block.turns().flat_map(|turn| turn.subdivide(steps)) {
            let dz = uneven_offset(n, path.task.tolerance.interpolation);
            match n == 0.0 {
                true => nodes.push(n),
                false => nodes.push_off(
                    n,
                    NodeOffset {
                        dz,
                        dz_dc: 3.0 * dz,
                    },
                ),
            }
        }
        nodes
    }))
}

/// Up to half the tolerance, and another one at each of 200 turns.
fn uneven_offset(n: f64, tolerance: f64) -> f64 {
    0.5 * tolerance * Scalar::sin(3.7 * n + 0.2)
}

/// The tolerance halves all segments of some turns. What the sampler placed stays where it was, with
/// its velocity, and what is new lies on the locus.
#[test]
fn halving_keeps_the_offsets_of_the_ends() {
    let task = Task {
        sampler: uneven(36.0),
        interpolation: 1.2 * exact_ends(RIM),
        ..Task::default()
    };
    let (before, _) = task.path();
    let (after, outcome) = Task {
        refined: true,
        ..task.clone()
    }
    .path();
    assert!(outcome.added_by_refine > 100);
    assert!(outcome.figures.playback.max() <= task.interpolation);
    let mut kept = 0;
    for point in after.points() {
        let placed = before.t.binary_search_by(|t| t.total_cmp(&point.t));
        if let Ok(index) = placed {
            assert_eq!(before.get(index), Some(point));
            kept += 1;
        } else {
            assert!(above_locus(&point).abs() < 1e-14, "{}", above_locus(&point));
        }
    }
    assert_eq!(kept, before.len());
    let off = before
        .points()
        .filter(|point| above_locus(point).abs() > 1e-7);
    assert!(off.count() > before.len() / 2);
}

/// Offsets of half the error on the other side: the error of equal steps halves everywhere.
#[test]
fn offsets_on_the_other_side_halve_the_error_of_equal_steps() {
    let balanced = NodesOff(|path: &Path<'_>, block: Revolutions| {
        let mut nodes = NodeList::default();
        for n in block.turns().flat_map(|turn| turn.subdivide(36.0)) {
            let half = 0.5 * exact_ends(path.radius_at(n));
            let (sin, cos) = Scalar::sin_cos(2.0 * angle(n));
            match n == 0.0 {
                true => nodes.push(n),
                false => nodes.push_off(
                    n,
                    NodeOffset {
                        dz: half * sin,
                        dz_dc: 2.0 * half * cos,
                    },
                ),
            }
        }
        nodes
    });
    let exact = largest_error(even(36.0));
    let found = largest_error(Arc::new(balanced));
    assert!((found / exact - 0.5).abs() < 0.02, "{}", found / exact);
}

/// A controller with steps of time: each node moves along the spiral, and stays as far off the
/// locus.
#[test]
fn a_node_that_moves_to_a_step_of_time_keeps_its_offset() {
    const STEPS: f64 = 37.0;
    let task = Task {
        sampler: uneven(STEPS),
        time_steps: Some(2500.0),
        ..Task::default()
    };
    let (path, outcome) = task.path();
    let from_step = |t: &f64| (t * 2500.0).round() - t * 2500.0;
    assert!(path.t.iter().all(|t| from_step(t).abs() < 1e-6));
    let mut moved = 0;
    for (k, point) in path.points().enumerate().skip(1).take(path.len() - 2) {
        let n = k as f64 / STEPS;
        moved += usize::from((point.c / TAU - n).abs() > 1e-6);
        let expected = uneven_offset(n, task.interpolation);
        let found = above_locus(&point);
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }
    assert!(moved > path.len() / 2);
    assert!(outcome.figures.points.max() < 1e-12);
}
