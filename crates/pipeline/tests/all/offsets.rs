//! Nodes off the locus: a segment may use the tolerance on both sides, halving keeps its ends where
//! they are, and a moved node keeps its offset.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{K, NodesOff, RIM, Task, even};
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

fn largest_error(sampler: Arc<dyn Sampler>, interpolation: f64, refined: bool) -> (f64, u64) {
    let task = Task {
        sampler,
        interpolation,
        refined,
        ..Task::default()
    };
    let (_, outcome) = task.path();
    assert!(outcome.figures.points.max() < 1e-12);
    (outcome.figures.playback.max(), outcome.added_by_refine)
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
        let (found, _) = largest_error(long_segments(ends), 1e-4, false);
        let part = found / whole / expected;
        assert!((part - 1.0).abs() < 0.03, "{part}");
    }
}

/// The tolerance lies a little below the error of the long segments in the first turns: these are
/// halved, and the others are not.
#[test]
fn halving_keeps_the_offsets_of_the_ends() {
    let tolerance = 0.98 * 0.25 * exact_ends(RIM);
    let (before, _) = largest_error(long_segments(Ends::Both), tolerance, false);
    assert!(before > tolerance);
    let (after, added) = largest_error(long_segments(Ends::Both), tolerance, true);
    assert!(after <= tolerance, "{after} of {tolerance}");
    assert!((1..20).contains(&added), "{added} points are new");
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
    let (exact, _) = largest_error(even(36.0), 1e-4, false);
    let (found, _) = largest_error(Arc::new(balanced), 1e-4, false);
    assert!((found / exact - 0.5).abs() < 0.02, "{}", found / exact);
}

/// A controller with steps of time: each node moves along the spiral, and stays as far off the
/// locus.
#[test]
fn a_node_that_moves_to_a_step_of_time_keeps_its_offset() {
    const OFFSET: f64 = 7e-6;
    let lifted = NodesOff(|_: &Path<'_>, block: Revolutions| {
        let mut nodes = NodeList::default();
        for n in block.turns().flat_map(|turn| turn.subdivide(37.0)) {
            let offset = NodeOffset {
                dz: OFFSET,
                dz_dc: 0.0,
            };
            match n == 0.0 {
                true => nodes.push(n),
                false => nodes.push_off(n, offset),
            }
        }
        nodes
    });
    let task = Task {
        sampler: Arc::new(lifted),
        time_steps: Some(2500.0),
        refined: true,
        ..Task::default()
    };
    let (path, outcome) = task.path();
    let step = |t: &f64| (t * 2500.0).round() - t * 2500.0;
    assert!(path.t.iter().all(|t| step(t).abs() < 1e-6));
    assert!(outcome.figures.points.max() < 1e-12);
    assert_eq!(outcome.figures.points.offset, Some(OFFSET));
}
