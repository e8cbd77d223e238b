//! How many nodes the papers' parts take, and where they lie.

use std::f64::consts::TAU;

use crate::common::{
    Case, ast_5, atpg, count, largest_error, minimax, nodes, nodes_between, params, smooth_law,
};
use crate::models::model;
use std::sync::Arc;
use turnpath_core::{NodeList, Params, Scalar, SpiralLaw, Strategy, Surface};
use turnpath_minimax::MinimaxSampler;
use turnpath_nose_radius::{Uncompensated, ZDirection};
use turnpath_surfaces::OffAxisParaboloid;

/// The parts of the points that `atpg` takes, of a prototype: 0.881, 0.774, 0.739.
#[test]
fn the_small_mirror() {
    let case = ast_5(ZDirection);
    let law = smooth_law(&case);
    let bound = count(&nodes(&case, &law, &atpg(45.0))) as f64;
    for (states, most) in [(1.0, 0.885), (3.0, 0.780), (7.0, 0.744), (25.0, 0.740)] {
        let part = count(&nodes(&case, &law, &minimax(states, 45.0))) as f64 / bound;
        assert!(part <= most, "{states} states: {part}");
    }
}

/// Slices of 24 turns of the large paraboloid: 0.933 and 0.787 of the points of `atpg`.
#[test]
fn slices_of_the_off_axis_paraboloid() {
    let params = Params::new()
        .with("vertex_radius", 915.0)
        .with("off_axis_distance", 915.0);
    let surface = model::<OffAxisParaboloid>(&params);
    let case = Case::new(surface, Arc::new(ZDirection), 213.0, 1.04, 10.0);
    let law = smooth_law(&case);
    let starts = (0..6).map(|k| (law.end() * (f64::from(k) + 0.5) / 6.0).floor());
    let starts: Vec<f64> = starts.collect();
    let of = |sampler: &dyn turnpath_core::Sampler| -> Vec<Vec<NodeList>> {
        let slice = |start: &f64| {
            nodes_between(&case, &law, sampler, (*start, start + 24.0)).expect("nodes")
        };
        starts.iter().map(slice).collect()
    };
    let total = |slices: &[Vec<NodeList>]| slices.iter().map(|s| count(s)).sum::<usize>() as f64;
    let bound = total(&of(&atpg(45.0)));
    for (states, most) in [(1.0, 0.945), (7.0, 0.80)] {
        let slices = of(&minimax(states, 45.0));
        assert!(
            total(&slices) <= most * bound,
            "{} of {bound}",
            total(&slices)
        );
        for (slice, start) in slices.iter().zip(&starts) {
            let worst = largest_error((&case, &case), &law, slice, start + 24.0);
            assert!(worst <= 0.99 * case.task.tolerance.interpolation, "{worst}");
        }
    }
}

/// A tilted flat: the largest step decides everywhere.
struct Ramp;

impl Surface for Ramp {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        x * 1e-6
    }
}

/// The length of the mean of all exp(8iθ) over the nodes: 1 where all lie on the same eight angles.
fn coherence(blocks: &[NodeList]) -> f64 {
    let (mut cos_sum, mut sin_sum, mut count) = (0.0, 0.0, 0.0);
    for n in blocks.iter().flat_map(NodeList::revolutions) {
        let (sin, cos) = Scalar::sin_cos(8.0 * TAU * n.fract());
        (cos_sum, sin_sum, count) = (cos_sum + cos, sin_sum + sin, count + 1.0);
    }
    (cos_sum * cos_sum + sin_sum * sin_sum).sqrt() / count
}

#[test]
fn steps_that_wander_leave_the_angles_of_the_turn_before() {
    let case = Case::new(Arc::new(Ramp), Arc::new(Uncompensated), 20.0, 1.0, 100.0);
    let mut law = SpiralLaw::new();
    law.push(64.0, [1.0, 0.01, 0.0, 0.0, 0.0, 0.0]);
    let of = |wander| {
        let sampler = MinimaxSampler::new(&params(7.0, 45.0, wander)).expect("a sampler");
        nodes(&case, &law, &sampler)
    };
    let (still, wandering) = (of(false), of(true));
    assert!(coherence(&still) > 0.999, "{}", coherence(&still));
    // 513 nodes on evenly spread angles cancel.
    assert!(coherence(&wandering) < 0.01, "{}", coherence(&wandering));
    assert!(count(&wandering) as f64 <= 1.01 * count(&still) as f64);
}
