//! Sampler `ats` on ATS's own paths: the errors of X and of Z that cubics with exact rates leave.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::common::{Case, ast_5, mla_5};
use crate::random::{array, compensating, one_case_in};
use proptest::prelude::{any, proptest};
use turnpath_ats::{AtsFeed, AtsSampler};
use turnpath_core::{
    DEG, NodeList, Params, Path, Revolutions, Sampler, Series, SpiralLaw, Strategy,
};
use turnpath_nose_radius::{Normal, ZDirection};

/// The part of the distance between passes that the sampler gives to X, and 1 % more, since the
/// distance changes along a step.
const FEED_PART: f64 = 1.01 * 5e-4;
/// Number of instants of a segment.
const INSTANTS: i32 = 16;

fn law(case: &Case) -> SpiralLaw {
    case.law(&AtsFeed::default()).unwrap()
}

fn path<'a>(case: &'a Case, law: &'a SpiralLaw) -> Path<'a> {
    Path {
        task: &case.task,
        locus: &case.locus,
        law,
        spindle: &case.spindle,
    }
}

fn nodes(path: &Path<'_>, max_step: f64) -> Vec<f64> {
    let sampler = AtsSampler::new(&Params::new().with("max_step", max_step * DEG)).unwrap();
    let (mut nodes, mut start) = (NodeList::default(), 0.0);
    let plan = sampler.plan(path).unwrap();
    while start < path.law.end() {
        let end = (start + 64.0).min(path.law.end());
        let block = Revolutions { start, end };
        plan.place(path, block, &mut nodes).unwrap();
        start = end;
    }
    nodes.push(path.law.end());
    nodes.revolutions().to_vec()
}

fn series(path: &Path<'_>, n: &[f64]) -> [Vec<Series>; 2] {
    let (mut x, mut z) = (vec![[0.0; 5]; n.len()], vec![[0.0; 5]; n.len()]);
    path.series_at(n, &mut x, &mut z).unwrap();
    [x, z]
}

/// The Hermite cubic on a step of length h at s in (0, 1), from the series at both ends.
fn cubic(ends: &[Series], h: f64, s: f64) -> f64 {
    let d = ends[1][0] - ends[0][0];
    let (a, b) = (h * ends[0][1], h * ends[1][1]);
    ends[0][0] + s * (a + s * (3.0 * d - 2.0 * a - b + s * (a + b - 2.0 * d)))
}

/// Checks that nodes increase by at most `max_step`, that the played X stays within its part of the
/// distance between passes, and that the played Z, less the effect of X's own error, stays within
/// the tolerance.
fn check(case: &Case, max_step: f64) {
    let law = law(case);
    let path = path(case, &law);
    let nodes = nodes(&path, max_step);
    let [x, z] = series(&path, &nodes);
    for (k, pair) in nodes.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        assert!(step > 0.0 && 360.0 * step <= max_step * (1.0 + 2e-3));
        let at: Vec<f64> = (1..INSTANTS)
            .map(|i| pair[0] + step * f64::from(i) / f64::from(INSTANTS))
            .collect();
        let [true_x, true_z] = series(&path, &at);
        for (i, n) in at.iter().enumerate() {
            let s = (i + 1) as f64 / f64::from(INSTANTS);
            let of = |series: &[Series]| cubic(&series[k..k + 2], TAU * step, s);
            let (off_x, off_z) = (of(&x) - true_x[i][0], of(&z) - true_z[i][0]);
            let next = if n + 1.0 < law.end() {
                n + 1.0
            } else {
                n - 1.0
            };
            let gap = (law.value(next) - law.value(*n)).abs();
            assert!(
                off_x.abs() <= FEED_PART * gap,
                "X by {off_x} of {gap} at {n}"
            );
            let slope = slope(case, *n, law.value(*n));
            let error = (off_z - slope * off_x).abs();
            let tolerance = case.task.tolerance.interpolation;
            assert!(error <= tolerance, "{error} at {n}");
        }
    }
}

/// ∂Z/∂X of the tool centre.
fn slope(case: &Case, n: f64, rho: f64) -> f64 {
    use turnpath_core::{Locus, Rates, angle};
    let mut out = [[0.0]; 4];
    let [x_theta, x_rho, z_theta, z_x] = &mut out;
    let rates = Rates {
        x_theta,
        x_rho,
        z_theta,
        z_x,
    };
    case.locus.rates(&[angle(n)], &[rho], rates).unwrap();
    out[3][0]
}

#[test]
fn on_the_papers_parts_both_axes_keep_their_tolerances() {
    for case in [
        ast_5(ZDirection),
        ast_5(ZDirection).inward(),
        ast_5(Normal),
        mla_5(ZDirection),
    ] {
        check(&case, 45.0);
    }
}

/// The sum of the pieces' lengths lies a hair beyond a block's start. The jump there must not cause
/// a step of that length.
#[test]
fn a_knot_a_hair_beyond_a_blocks_start_is_where_it_starts() {
    let case = ast_5(ZDirection);
    let mut law = SpiralLaw::new();
    let hair = 4e-12;
    law.push(64.0 + hair, [0.0, 0.01, 0.0, 0.0, 0.0, 0.0]);
    law.push(2.0, [0.01 * (64.0 + hair), 0.02, 0.0, 0.0, 0.0, 0.0]);
    let nodes = nodes(&path(&case, &law), 45.0);
    let steps = nodes.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(nodes.contains(&64.0));
    let shortest = steps.fold(f64::INFINITY, f64::min);
    assert!(shortest > 1e-3, "{shortest} revolutions");
}

proptest! {
    #![proptest_config(one_case_in(8))]

    #[test]
    fn on_arrays_both_axes_keep_their_tolerances(
        amplitude in 0.001..0.006f64,
        frequency in 0.1..0.5f64,
        which in any::<bool>(),
        inward in any::<bool>(),
        max_step in 10.0..90.0f64,
    ) {
        let surface = array(amplitude, frequency, "product");
        let case = Case::new(surface, compensating(which), 5.0, 0.8, 100.0);
        check(&if inward { case.inward() } else { case }, max_step);
    }
}
