//! Arcs against closed forms, across blocks, and against the third paper's Fig. 10.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::models::model;
use proptest::prelude::{ProptestConfig, any, prop_assert, prop_assert_eq, proptest};
use std::f64::consts::TAU;
use std::sync::Arc;
use turnpath_core::{
    DEG, Direction, Machine, NodeList, Params, Part, Path, RadialRange, Revolutions, Sampler,
    Series, SpindleLaw, SpiralLaw, Strategy, Task, Tolerance, Tool, ToolLocus,
};
use turnpath_integrated::{EqualAngle, EqualArc, Integrated};
use turnpath_nose_radius::Uncompensated;
use turnpath_surfaces::Astigmatic;

/// The stand-in for the paper's toric surface: z = 0.6 mm (ρ/20)² sin 2θ on 40 mm.
const K: f64 = 0.0015;
const RIM: f64 = 20.0;

fn task() -> Task {
    Task {
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
            interpolation: 1e-5,
            residual: 1e-4,
        },
        range: RadialRange {
            inner: 0.0,
            outer: RIM,
        },
        direction: Direction::Inward,
        machine: Machine::default(),
        spindle_speed: 52.0,
    }
}

/// A law of one piece.
fn spiral(from: f64, rate: f64, turns: f64) -> SpiralLaw {
    let mut law = SpiralLaw::new();
    law.push(turns, [from, rate, 0.0, 0.0, 0.0, 0.0]);
    law
}

fn equal_arc(spacing: f64) -> Box<dyn Sampler> {
    Box::new(EqualArc::new(&Params::new().with("spacing", spacing)).unwrap())
}

fn integrated(spacing: f64, max_step: f64) -> Box<dyn Sampler> {
    let params = Params::new()
        .with("spacing", spacing)
        .with("max_step", max_step * DEG);
    Box::new(Integrated::new(&params).unwrap())
}

fn equal_angle(step: f64) -> Box<dyn Sampler> {
    let params = Params::new()
        .with("step", step * DEG)
        .with("max_step", 90.0 * DEG);
    Box::new(EqualAngle::new(&params).unwrap())
}

fn locus(task: &Task) -> ToolLocus {
    let surface = model::<Astigmatic>(&Params::new().with("k", K));
    ToolLocus::new(surface, Arc::new(Uncompensated), task.tool)
}

/// The nodes of a path, sampled in blocks of `block` revolutions.
fn nodes(sampler: &dyn Sampler, law: &SpiralLaw, block: f64) -> Vec<f64> {
    let task = task();
    let locus = locus(&task);
    let spindle = SpindleLaw::constant(52.0);
    let whole = Path {
        task: &task,
        locus: &locus,
        law,
        spindle: &spindle,
    };
    let plan = sampler.plan(&whole).unwrap();
    let (mut nodes, mut state, mut start) = (NodeList::default(), Vec::new(), 0.0);
    while start < law.end() {
        let end = (start + block).min(law.end());
        let window = law.window(start - 1.0, end + 1.0);
        let path = Path {
            task: &task,
            locus: &locus,
            law: &window,
            ..whole
        };
        plan.place_sequential(&path, Revolutions { start, end }, &mut state, &mut nodes)
            .unwrap();
        start = end;
    }
    nodes.revolutions().to_vec()
}

#[test]
fn on_a_circle_an_arc_is_radius_times_angle() {
    let law = spiral(5.0, 0.0, 10.0);
    let spacing = TAU * 5.0 / 100.0;
    let found = nodes(equal_arc(spacing).as_ref(), &law, 64.0);
    assert_eq!(found.len(), 1000);
    for (k, n) in found.iter().enumerate() {
        assert!((n - k as f64 / 100.0).abs() < 1e-10);
    }
}

/// ρ = cθ: the arc is c/2 (θ·sqrt(1 + θ²) + arsinh θ).
#[test]
fn on_an_archimedean_spiral_the_arc_is_the_closed_form() {
    let feed = 0.05;
    let law = spiral(0.0, feed, 40.0);
    let arc = |n: f64| {
        let theta = TAU * n;
        let root = (1.0 + theta * theta).sqrt();
        let arsinh = turnpath_core::Scalar::ln(theta + root);
        0.5 * feed / TAU * (theta * root + arsinh)
    };
    let found = nodes(equal_arc(0.25).as_ref(), &law, 64.0);
    let mut free = 0;
    for pair in found.windows(2) {
        let (step, length) = (pair[1] - pair[0], arc(pair[1]) - arc(pair[0]));
        if step < 0.25 - 1e-12 {
            assert!(
                (length / 0.25 - 1.0).abs() < 1e-6,
                "{length} at {}",
                pair[0]
            );
            free += 1;
        } else {
            assert!(length <= 0.25);
        }
    }
    assert!(free > 500 && found.len() - free > 5);
    let last = found[found.len() - 1];
    assert!(last < 40.0 && arc(40.0) - arc(last) <= 0.25 * (1.0 + 1e-6));
}

#[test]
fn where_the_tool_stands_still_on_the_axis_the_largest_step_is_the_limit() {
    let law = spiral(0.0, 0.0, 3.0);
    assert_eq!(nodes(equal_arc(0.1).as_ref(), &law, 64.0).len(), 12);
    assert_eq!(nodes(integrated(0.1, 30.0).as_ref(), &law, 64.0).len(), 36);
}

/// 20 mm and 0.001° are 0.349 µm.
#[test]
fn a_spacing_of_too_many_points_is_an_error_on_spacing() {
    let (task, law) = (task(), spiral(RIM, -0.05, 400.0));
    let locus = locus(&task);
    let path = Path {
        task: &task,
        locus: &locus,
        law: &law,
        spindle: &SpindleLaw::constant(52.0),
    };
    let block = Revolutions {
        start: 0.0,
        end: 1.0,
    };
    let mut nodes = NodeList::default();
    for (spacing, fits) in [(0.34e-3, false), (0.36e-3, true)] {
        let plan = equal_arc(spacing).plan(&path).unwrap();
        let answer = plan.place(&path, block, &mut nodes);
        assert_eq!(answer.is_ok(), fits);
        if let Err(error) = answer {
            assert!(error.to_string().contains("at least 0.35 um"), "{error}");
        }
    }
}

/// Inside of spacing/max_step, 11.46 mm, the integrated steps are the largest angle. Outside of it
/// they are the arc.
#[test]
fn integrated_steps_are_the_smaller_of_both() {
    let law = spiral(RIM, -0.05, 400.0);
    let found = nodes(integrated(1.0, 5.0).as_ref(), &law, 64.0);
    for pair in found.windows(2) {
        let (step, rho) = (
            360.0 * (pair[1] - pair[0]),
            law.value(0.5 * (pair[0] + pair[1])),
        );
        let expected = (1.0 / rho / DEG).min(5.0);
        assert!((step / expected - 1.0).abs() < 1e-3, "{step} at {rho}");
    }
}

/// The Hermite cubic on a step of length h at its middle, from the series at both ends.
fn middle(from: &Series, to: &Series, h: f64) -> f64 {
    0.5 * (from[0] + to[0]) + 0.125 * h * (from[1] - to[1])
}

/// The largest error, mm, of cubics with exact rates in each of `rings` rings of equal width, the
/// inner ring first.
fn error_against_radius(sampler: &dyn Sampler, rings: usize) -> Vec<f64> {
    let (task, law) = (task(), spiral(RIM, -0.05, 400.0));
    let locus = locus(&task);
    let nodes = nodes(sampler, &law, 64.0);
    let path = Path {
        task: &task,
        locus: &locus,
        law: &law,
        spindle: &SpindleLaw::constant(52.0),
    };
    let series = |n: &[f64]| {
        let (mut x, mut z) = (vec![[0.0; 5]; n.len()], vec![[0.0; 5]; n.len()]);
        path.series_at(n, &mut x, &mut z).unwrap();
        z
    };
    let middles: Vec<f64> = nodes
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    let (ends, truth) = (series(&nodes), series(&middles));
    let mut worst = vec![0.0f64; rings];
    for ((pair, ends), (n, truth)) in nodes
        .windows(2)
        .zip(ends.windows(2))
        .zip(middles.iter().zip(&truth))
    {
        let h = TAU * (pair[1] - pair[0]);
        let ring = (law.value(*n) / RIM * rings as f64) as usize;
        let error = (middle(&ends[0], &ends[1], h) - truth[0]).abs();
        worst[ring.min(rings - 1)] = worst[ring.min(rings - 1)].max(error);
    }
    worst
}

/// The prediction of eq. 10 for the stand-in: |z⁗| = 16Kρ² at most, so a step of L errs by
/// Kρ²L⁴/24.
fn predicted(rho: f64, step: f64) -> f64 {
    K * rho * rho * step * step * step * step / 24.0
}

/// The third paper's Fig. 10, whose scales are not legible. With equal angles the error grows with
/// ρ² and is worst in the outermost ring. With equal arcs it grows as 1/ρ² inwards. With the
/// integrated method it is the smaller of both everywhere, and worst where they meet.
#[test]
fn figure_10_equal_angles_are_worst_outside_equal_arcs_inside_integrated_neither() {
    let rings = 20;
    let by = |sampler: Box<dyn Sampler>| error_against_radius(sampler.as_ref(), rings);
    let (angle, arc, both) = (
        by(equal_angle(5.0)),
        by(equal_arc(1.0)),
        by(integrated(1.0, 5.0)),
    );
    let worst = |errors: &[f64]| (0..rings).max_by(|i, j| errors[*i].total_cmp(&errors[*j]));
    assert_eq!(worst(&angle), Some(19));
    assert!(worst(&arc) <= Some(1), "{:?}", worst(&arc));
    assert_eq!(worst(&both), Some(11));
    for ring in 2..rings {
        let (from, to) = (ring as f64, (ring + 1) as f64);
        let of_angle = predicted(to, 5.0 * DEG);
        let of_arc = predicted(from, 1.0 / from);
        assert!((angle[ring] / of_angle - 1.0).abs() < 0.02, "{ring}");
        assert!(
            (arc[ring] / of_arc - 1.0).abs() < 0.12,
            "{ring}: {} {of_arc}",
            arc[ring]
        );
        let smaller = of_angle.min(of_arc).min(predicted(11.459, 5.0 * DEG));
        assert!(both[ring] <= 1.02 * smaller, "{ring}");
    }
    let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
    assert!(3.0 * largest(&both) < largest(&angle));
    assert!(100.0 * largest(&both) < largest(&arc));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn blocks_have_no_effect_and_nodes_increase(
        spacing in 0.05..5.0f64,
        max_step in 1.0..90.0f64,
        turns in 0.1..150.0f64,
        inner in 0.0..3.0f64,
        block in 1u32..70,
        inward in any::<bool>(),
    ) {
        let width = 2.5;
        let law = match inward {
            true => spiral(inner + width, -width / turns, turns),
            false => spiral(inner, width / turns, turns),
        };
        for sampler in [equal_arc(spacing), integrated(spacing, max_step)] {
            let whole = nodes(sampler.as_ref(), &law, 1e9);
            prop_assert_eq!(&whole, &nodes(sampler.as_ref(), &law, f64::from(block)));
            prop_assert_eq!(whole[0], 0.0);
            for pair in whole.windows(2) {
                prop_assert!(pair[1] > pair[0] && pair[1] - pair[0] <= 0.25 * (1.0 + 1e-12));
            }
            prop_assert!(whole[whole.len() - 1] < turns);
        }
    }
}
