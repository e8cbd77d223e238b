//! Sampler `atpg` under a speed that changes much within a turn: the cubics between its nodes, played
//! in time with exact rates, against the true tool centre at the C and the X of each instant.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::common::{AtpgCase, Case, ast_5};
use turnpath_atpg::AtpgSampler;
use turnpath_core::{
    CentreSeries, Locus, NM, NodeList, ParamValue, Params, Path, Piece, PiecewisePolynomial,
    Revolutions, Sampler, Series, SpindleLaw, SpiralLaw, Strategy, angle, per_radian, quintic,
};
use turnpath_nose_radius::ZDirection;

/// Instants of a segment.
const INSTANTS: usize = 40;
/// Revolutions that are looked at.
const PART: f64 = 40.0;

/// A speed that goes up and down by `swing` of itself, in pieces of a third of a turn: dt/dN is
/// 0.12 s more or less, and its slope at the knots is that of a wave of two turns.
fn swinging(swing: f64) -> SpindleLaw {
    let (piece, mean) = (1.0 / 3.0, 0.12);
    let count = (PART / piece).ceil() as usize + 6;
    let wave = [
        0.0,
        0.75_f64.sqrt(),
        0.75_f64.sqrt(),
        0.0,
        -(0.75_f64.sqrt()),
        -(0.75_f64.sqrt()),
    ];
    let slope = [1.0, 0.5, -0.5, -1.0, -0.5, 0.5];
    let end = |k: usize, t: f64| {
        let rate = mean * (1.0 + swing * wave[k % 6]);
        [t, rate, mean * swing * slope[k % 6] * TAU / 2.0]
    };
    let (mut t, mut pieces) = (0.0, Vec::new());
    for k in 0..count {
        let [from, to] = [end(k, t)[1], end(k + 1, t)[1]];
        let next = t + piece * 0.5 * (from + to);
        pieces.push(Piece {
            start: piece * k as f64,
            coefficients: quintic(end(k, t), end(k + 1, next), piece),
        });
        t = next;
    }
    SpindleLaw::from_time(PiecewisePolynomial::from_pieces(
        pieces,
        piece * count as f64,
    ))
}

fn nodes(case: &Case, law: &SpiralLaw, spindle: &SpindleLaw) -> Vec<f64> {
    let path = Path {
        task: &case.task,
        locus: &case.locus,
        law,
        spindle,
    };
    let mut params = Params::new().with("max_step", 0.8);
    params.set("wander", ParamValue::Flag(false));
    let sampler = AtpgSampler::new(&params).unwrap();
    let block = Revolutions {
        start: 0.0,
        end: PART,
    };
    let mut nodes = NodeList::default();
    sampler
        .plan(&path)
        .unwrap()
        .place(&path, block, &mut nodes)
        .unwrap();
    nodes.revolutions().to_vec()
}

/// The Hermite cubic over `h` seconds from a value and a rate to others.
fn cubic(from: [f64; 2], to: [f64; 2], h: f64, s: f64) -> f64 {
    let (a, b) = (h * from[1], h * to[1]);
    let d = to[0] - from[0];
    from[0] + s * (a + s * (3.0 * d - 2.0 * a - b + s * (a + b - 2.0 * d)))
}

/// The largest |played − true| along z, mm.
fn largest_error(case: &Case, law: &SpiralLaw, spindle: &SpindleLaw, nodes: &[f64]) -> f64 {
    let theta: Vec<Series> = nodes
        .iter()
        .map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0])
        .collect();
    let rho: Vec<Series> = nodes.iter().map(|n| per_radian(law.series(*n))).collect();
    let (mut x, mut z) = (vec![[0.0; 5]; nodes.len()], vec![[0.0; 5]; nodes.len()]);
    let out = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    case.locus.series(&theta, &rho, out).unwrap();
    let (mut c, mut at_x, mut played) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..nodes.len() - 1 {
        let h = spindle.time_at(nodes[k + 1]) - spindle.time_at(nodes[k]);
        let speed = [k, k + 1].map(|i| spindle.speed_at(nodes[i]));
        let ends = |p: &[Series]| {
            [
                [p[k][0], speed[0] * p[k][1]],
                [p[k + 1][0], speed[1] * p[k + 1][1]],
            ]
        };
        let of_c = [[TAU * nodes[k], speed[0]], [TAU * nodes[k + 1], speed[1]]];
        for i in 0..INSTANTS {
            let s = i as f64 / INSTANTS as f64;
            let at = |[from, to]: [[f64; 2]; 2]| cubic(from, to, h, s);
            c.push(at(of_c));
            at_x.push(at(ends(&x)));
            played.push(at(ends(&z)));
        }
    }
    let truth = case.heights(&c, &at_x);
    let errors = played
        .iter()
        .zip(&truth)
        .map(|(z, truth)| (z - truth).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn nodes_hold_the_tolerance_under_a_speed_that_changes_much() {
    let case = ast_5(ZDirection);
    let law = case.plan_law("held", "smooth").unwrap();
    let tolerance = case.task.tolerance.interpolation;
    for swing in [0.05, 0.2] {
        let spindle = swinging(swing);
        let own = nodes(&case, &law, &spindle);
        let error = largest_error(&case, &law, &spindle, &own);
        assert!(error <= 1.001 * tolerance, "{} nm at {swing}", error / NM);
        assert!(error >= 0.5 * tolerance, "{} nm at {swing}", error / NM);
        let even = nodes(&case, &law, &SpindleLaw::constant(50.0));
        let without = largest_error(&case, &law, &spindle, &even);
        assert!(without > error, "{} nm at {swing}", without / NM);
        // Nodes for a constant speed lose their margin where the speed changes little, and more
        // where it changes much.
        assert!(
            (without > tolerance) == (swing > 0.1),
            "{} nm at {swing}",
            without / NM
        );
    }
}
