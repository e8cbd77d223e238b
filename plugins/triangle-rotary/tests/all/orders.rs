//! The effect of every solver on the played position: orders of convergence, closed forms, ends,
//! and blocks that join.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use proptest::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{DEG, Dependence, Nodes, Params, Scalar, Strategy, Velocities, VelocitySolver};
use turnpath_triangle_rotary::{Analytic, Area, Linear, ThreePoint, TriangleRotary};

/// Number of instants of a segment at which the played position is compared.
const INSTANTS: i32 = 16;

fn area(c: f64) -> Area {
    Area::new(&Params::new().with("c", c)).unwrap()
}

fn triangle_rotary(ends: &str) -> TriangleRotary {
    let mut params = Params::new();
    params.set("ends", turnpath_core::ParamValue::Text(ends.into()));
    TriangleRotary::new(&params).unwrap()
}

/// A position and its rate at a time.
type Motion = fn(f64) -> (f64, f64);

/// The three axes as functions of time.
#[derive(Clone, Copy)]
struct Axes([Motion; 3]);

impl Axes {
    /// C, X and Z without a special meaning: none of their derivatives is zero throughout.
    fn wavy() -> Self {
        Self([
            |t| {
                let (s, c) = Scalar::sin_cos(t);
                (3.0 * t + 0.2 * s, 3.0 + 0.2 * c)
            },
            |t| {
                let e = Scalar::exp(-0.5 * t);
                (2.0 * e, -e)
            },
            |t| {
                let (s, c) = Scalar::sin_cos(2.0 * t + 0.3);
                let (s5, c5) = Scalar::sin_cos(5.0 * t);
                (0.4 * s + 0.05 * s5, 0.8 * c + 0.25 * c5)
            },
        ])
    }

    /// Positions and rates at the nodes, axis by axis.
    fn at(&self, t: &[f64]) -> [(Vec<f64>, Vec<f64>); 3] {
        self.0.map(|axis| t.iter().map(|t| axis(*t)).unzip())
    }

    /// The path that a solver makes from blocks that end at the nodes in `joints`. A block begins
    /// with the last node of the block before, and has `overlap` more nodes.
    fn path(&self, solver: &dyn VelocitySolver, t: &[f64], joints: &[usize]) -> PathBlock {
        let [(c, c_rate), (x, x_rate), (z, z_rate)] = self.at(t);
        let z_theta: Vec<f64> = z_rate.iter().zip(&c_rate).map(|(z, c)| z / c).collect();
        let z_x = vec![0.0; t.len()];
        let overlap = match solver.dependence() {
            Dependence::Overlap(nodes) => nodes,
            _ => 0,
        };
        let mut path = PathBlock {
            shape: solver.segments(),
            ..PathBlock::default()
        };
        let (mut start, mut state) = (0usize, Vec::new());
        for end in joints.iter().copied().chain([t.len() - 1]) {
            let (from, to) = (
                start.saturating_sub(overlap),
                (end + overlap + 1).min(t.len()),
            );
            let nodes = Nodes {
                t: &t[from..to],
                c: &c[from..to],
                x: &x[from..to],
                z: &z[from..to],
                c_rate: &c_rate[from..to],
                x_rate: &x_rate[from..to],
                z_theta: &z_theta[from..to],
                z_x: &z_x[from..to],
                at_start: from == 0,
                at_end: to == t.len(),
            };
            let mut v = [(); 3].map(|()| vec![f64::NAN; to - from]);
            let [vc, vx, vz] = &mut v;
            let out = Velocities {
                c: vc,
                x: vx,
                z: vz,
            };
            match solver.dependence() {
                Dependence::Sequential => solver.solve_sequential(nodes, &mut state, out).unwrap(),
                _ => solver.solve(nodes, out).unwrap(),
            }
            path.truncate(start);
            for k in start..=end {
                path.push(ControlPoint {
                    t: t[k],
                    c: c[k],
                    x: x[k],
                    z: z[k],
                    vc: v[0][k - from],
                    vx: v[1][k - from],
                    vz: v[2][k - from],
                });
            }
            start = end;
        }
        path
    }

    /// The largest |played − true| of each segment, over all axes.
    fn errors(&self, path: &PathBlock) -> Vec<f64> {
        let of_segment = |segment: turnpath_core::toolpath::Segment| {
            let mut worst = 0.0f64;
            for i in 0..INSTANTS {
                let s = f64::from(i) / f64::from(INSTANTS);
                let t = segment.start + s * segment.duration;
                let played = [segment.c, segment.x, segment.z].map(|axis| axis.value(s));
                for (axis, played) in self.0.iter().zip(played) {
                    worst = worst.max((played - axis(t).0).abs());
                }
            }
            worst
        };
        path.segments().map(of_segment).collect()
    }
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most, error| error.max(most))
}

/// Steps from 1 to 3 in no order, each divided into `parts`, 4 s in all.
fn halved(parts: u32) -> Vec<f64> {
    let steps: Vec<f64> = (0..24)
        .map(|k| 1.0 + 2.0 * (f64::from(k) * 0.618_034).fract())
        .collect();
    let scale = 4.0 / steps.iter().sum::<f64>();
    let (mut t, mut start) = (vec![0.0], 0.0);
    for step in steps {
        let width = scale * step;
        t.extend((1..=parts).map(|i| start + width * f64::from(i) / f64::from(parts)));
        start += width;
    }
    t
}

/// `count` steps over 4 s that grow and shrink smoothly by 1 : 5.
fn graded(count: u32) -> Vec<f64> {
    let place = |k| 4.0 * f64::from(k) / f64::from(count);
    (0..=count)
        .map(|k| place(k) - 0.4244 * Scalar::sin(TAU * place(k) / 4.0))
        .collect()
}

/// The power of two by which the error falls when every step is halved.
fn order(solver: &dyn VelocitySolver, nodes: impl Fn(u32) -> Vec<f64>, parts: u32) -> f64 {
    let axes = Axes::wavy();
    let error = |parts| largest(&axes.errors(&axes.path(solver, &nodes(parts), &[])));
    Scalar::ln(error(parts) / error(2 * parts)) / Scalar::ln(2.0)
}

#[test]
fn orders_of_convergence_on_uneven_steps_are_those_of_theory() {
    let expected: [(&str, &dyn VelocitySolver, f64); 7] = [
        ("analytic", &Analytic, 4.0),
        ("triangle-rotary", &triangle_rotary("clamped"), 4.0),
        ("natural", &triangle_rotary("natural"), 2.0),
        ("three-point", &ThreePoint, 3.0),
        ("area 2/3", &area(2.0 / 3.0), 2.0),
        ("area 1/2", &area(0.5), 3.0),
        ("linear", &Linear, 2.0),
    ];
    for (name, solver, expected) in expected {
        for (steps, found) in [
            ("halved", order(solver, halved, 16)),
            ("graded", order(solver, graded, 512)),
        ] {
            assert!(
                (found - expected).abs() < 0.1,
                "{name}, {steps}: {found:.3}"
            );
        }
    }
}

/// An error of ¹/₁₀ at the start is gone after 50 nodes with c = ⅔, and stays for ever with c = ½.
#[test]
fn an_error_of_velocity_halves_with_two_thirds_and_rings_with_a_half() {
    let t: Vec<f64> = (0..=50).map(f64::from).collect();
    let zeros = vec![0.0; t.len()];
    let mut rate = zeros.clone();
    rate[0] = 0.1;
    let last = |c: f64| {
        let nodes = Nodes {
            t: &t,
            c: &zeros,
            x: &zeros,
            z: &zeros,
            c_rate: &rate,
            x_rate: &rate,
            z_theta: &zeros,
            z_x: &zeros,
            at_start: true,
            at_end: true,
        };
        let mut v = [(); 3].map(|()| zeros.clone());
        let [vc, vx, vz] = &mut v;
        let out = Velocities {
            c: vc,
            x: vx,
            z: vz,
        };
        area(c).solve(nodes, out).unwrap();
        (v[0][49], v[0][50])
    };
    assert_eq!(last(0.5), (-0.1, 0.1));
    let halved = 0.1 * Scalar::powf(0.5, 50.0);
    assert!((last(2.0 / 3.0).1 / halved - 1.0).abs() < 1e-12);
}

/// The toric stand-in: z = 0.6 mm (ρ/20)² sin 2θ, 5° steps, 0.05 mm a revolution, 1000 points
/// inward from the rim. The third paper's value of 0.06 µm lies between the error of the interior
/// and the error with exact rates at both ends.
#[test]
fn three_point_on_the_toric_stand_in_agrees_with_the_publication_inside_and_at_the_ends() {
    fn radius(theta: f64) -> (f64, f64) {
        (20.0 - 0.05 * theta / TAU, -0.05 / TAU)
    }
    let axes = Axes([
        |theta| (theta, 1.0),
        radius,
        |theta| {
            let ((rho, rate), (s, c)) = (radius(theta), Scalar::sin_cos(2.0 * theta));
            let scale = 0.6 / 400.0;
            let along = 2.0 * rho * rho * c + 2.0 * rho * rate * s;
            (scale * rho * rho * s, scale * along)
        },
    ]);
    let theta: Vec<f64> = (0..1000).map(|k| 5.0 * DEG * f64::from(k)).collect();
    let errors_nm: Vec<f64> = axes
        .errors(&axes.path(&ThreePoint, &theta, &[]))
        .iter()
        .map(|error| error * 1e6)
        .collect();
    let interior = largest(&errors_nm[1..998]);
    assert!((interior / 51.0 - 1.0).abs() < 0.05, "{interior}");
    let all = largest(&errors_nm);
    assert!((all / 77.0 - 1.0).abs() < 0.05, "{all}");
}

#[test]
fn three_points_and_halves_play_a_parabola_exactly() {
    let axes = Axes([
        |t| (t, 1.0),
        |t| (2.0 - t + 0.5 * t * t, -1.0 + t),
        |t| (0.25 * t * t, 0.5 * t),
    ]);
    for solver in [&ThreePoint as &dyn VelocitySolver, &area(0.5), &Analytic] {
        let errors = axes.errors(&axes.path(solver, &halved(1), &[]));
        assert!(largest(&errors) < 1e-13, "{}", largest(&errors));
    }
}

#[test]
fn straight_segments_carry_the_rate_of_the_segment_that_follows() {
    let (axes, t) = (Axes::wavy(), halved(1));
    let path = axes.path(&Linear, &t, &[]);
    let rate = |k: usize| (path.z[k + 1] - path.z[k]) / (path.t[k + 1] - path.t[k]);
    let last = path.len() - 1;
    for k in 0..last {
        assert_eq!(path.vz[k], rate(k));
    }
    assert_eq!(path.vz[last], rate(last - 1));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    /// However a path is divided into blocks, the solvers that depend on no more than one node give
    /// the same bits, also across the plugin boundary.
    #[test]
    fn joints_of_blocks_have_no_effect(
        cuts in prop::collection::btree_set(1usize..96, 0..8),
        c in 0.5..1.0f64,
    ) {
        let (axes, t) = (Axes::wavy(), halved(4));
        let joints: Vec<usize> = cuts.into_iter().collect();
        let offers = turnpath_plugin::linked();
        let params = Params::new().with("c", c);
        let boxed = |name: &str| {
            let offer = offers.iter().find(|offer| offer.info().name == name).unwrap();
            offer.velocity(&params).unwrap()
        };
        let (three_point, linear, area) = (boxed("three-point"), boxed("linear"), boxed("area"));
        for solver in [three_point, linear, area] {
            let whole = axes.path(solver.as_ref(), &t, &[]);
            prop_assert_eq!(&whole, &axes.path(solver.as_ref(), &t, &joints));
        }
    }
}
