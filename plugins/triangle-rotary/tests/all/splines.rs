//! The spline against scipy's spline, and a path in windows against the whole path.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use proptest::prelude::*;
use serde_json::Value;
use turnpath_core::{Nodes, ParamValue, Params, Scalar, Strategy, Velocities, VelocitySolver};
use turnpath_triangle_rotary::{Analytic, TriangleRotary};

const REFERENCE: &str = include_str!("../../../../tests/reference/splines.json");
const BOUNDARIES: [&str; 3] = ["clamped", "natural", "not-a-knot"];
const OVERLAP: usize = 64;

fn params(ends: &str) -> Params {
    let mut params = Params::new();
    params.set("ends", ParamValue::Text(ends.into()));
    params
}

fn triangle_rotary(ends: &str) -> TriangleRotary {
    TriangleRotary::new(&params(ends)).unwrap()
}

/// Nodes as columns. Z's rate is given as ∂Z/∂θ at vC = 1.
#[derive(Default, Clone)]
struct Columns {
    t: Vec<f64>,
    values: [Vec<f64>; 3],
    rates: [Vec<f64>; 3],
}

impl Columns {
    fn solve(&self, solver: &dyn VelocitySolver, from: usize, to: usize) -> [Vec<f64>; 3] {
        let count = to - from;
        let [c, x, z] = &self.values;
        let (one, none) = (vec![1.0; count], vec![0.0; count]);
        let [c_rate, x_rate, z_rate] = &self.rates;
        let z_theta: Vec<f64> = (from..to).map(|k| z_rate[k] / c_rate[k]).collect();
        let nodes = Nodes {
            t: &self.t[from..to],
            c: &c[from..to],
            x: &x[from..to],
            z: &z[from..to],
            c_rate: &c_rate[from..to],
            x_rate: &x_rate[from..to],
            z_theta: &z_theta,
            z_x: &none,
            at_start: from == 0,
            at_end: to == self.t.len(),
        };
        let mut out = [one.clone(), one.clone(), one];
        let [c, x, z] = &mut out;
        solver.solve(nodes, Velocities { c, x, z }).unwrap();
        out
    }

    fn whole(&self, solver: &dyn VelocitySolver) -> [Vec<f64>; 3] {
        self.solve(solver, 0, self.t.len())
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Smooth axes of about the size of a spindle's, at the given times.
fn smooth(t: Vec<f64>) -> Columns {
    let at = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { t.iter().map(|t| f(*t)).collect() };
    let values = [
        at(&|t| 52.36 * t),
        at(&|t| 2.5 - 0.2 * t + 0.01 * Scalar::sin(9.0 * t)),
        at(&|t| 0.4 * Scalar::sin(104.7 * t + 0.3)),
    ];
    let rates = [
        at(&|_| 52.36),
        at(&|t| -0.2 + 0.09 * Scalar::cos(9.0 * t)),
        at(&|t| 41.88 * Scalar::cos(104.7 * t + 0.3)),
    ];
    Columns { t, values, rates }
}

fn times(steps: &[f64]) -> Vec<f64> {
    let mut t = vec![0.0];
    t.extend(steps.iter().scan(0.0, |sum, step| {
        *sum += step;
        Some(*sum)
    }));
    t
}

fn worst(found: &[f64], exact: &[f64]) -> f64 {
    let off = found.iter().zip(exact);
    off.map(|(f, e)| (f - e).abs()).fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

#[test]
fn slopes_agree_with_scipy() {
    let cases: Value = serde_json::from_str(REFERENCE).unwrap();
    for (i, case) in cases["cases"].as_array().unwrap().iter().enumerate() {
        let ends = case["ends"].as_str().unwrap();
        let t = numbers(&case["t"]);
        let rates = std::array::from_fn(|axis| {
            let mut rates = vec![1.0; t.len()];
            let given = numbers(&case["end_rates"][axis]);
            (rates[0], rates[t.len() - 1]) = (given[0], given[1]);
            rates
        });
        let columns = Columns {
            values: std::array::from_fn(|axis| numbers(&case["values"][axis])),
            t,
            rates,
        };
        let found = columns.whole(&triangle_rotary(ends));
        for (axis, found) in found.iter().enumerate() {
            let exact = numbers(&case["slopes"][axis]);
            let off = worst(found, &exact) / largest(&exact);
            assert!(off < 1e-13, "case {i}, {ends}, axis {axis}: {off:e}");
        }
    }
}

#[test]
fn windows_with_their_overlap_give_the_whole() {
    let steps: Vec<f64> = (0..2000)
        .map(|k| 1e-3 * Scalar::powf(1000.0, (f64::from(k) * 0.618).fract() - 0.5))
        .collect();
    let columns = smooth(times(&steps));
    let count = columns.t.len();
    for ends in BOUNDARIES {
        let solver = triangle_rotary(ends);
        let whole = columns.whole(&solver);
        for start in (0..count).step_by(150) {
            let end = (start + 150).min(count);
            let (from, to) = (start.saturating_sub(OVERLAP), (end + OVERLAP).min(count));
            let window = columns.solve(&solver, from, to);
            for (window, whole) in window.iter().zip(&whole) {
                let off = worst(&window[start - from..end - from], &whole[start..end]);
                let scale = largest(whole);
                assert!(
                    off <= 4e-15 * scale,
                    "{ends}, from node {start}: {off:e} of {scale}"
                );
            }
        }
    }
}

#[test]
fn across_the_boundary_windows_keep_their_ends() {
    let columns = smooth(times(&[0.01, 0.02, 0.005, 0.01]));
    let offers = turnpath_plugin::linked();
    let offer = offers
        .iter()
        .find(|offer| offer.info().name == "triangle-rotary");
    for ends in BOUNDARIES {
        let (here, there) = (
            triangle_rotary(ends),
            offer.unwrap().velocity(&params(ends)).unwrap(),
        );
        for (from, to) in [(0, 5), (0, 4), (1, 5), (1, 4)] {
            let found = columns.solve(there.as_ref(), from, to);
            assert_eq!(
                found,
                columns.solve(&here, from, to),
                "{ends}, {from} to {to}"
            );
        }
    }
}

#[test]
fn one_node_has_the_exact_rates() {
    let columns = smooth(vec![0.25]);
    for ends in BOUNDARIES {
        let found = columns.whole(&triangle_rotary(ends));
        for (found, exact) in found.iter().zip(&columns.rates) {
            assert!(worst(found, exact) < 1e-14);
        }
    }
    let none = smooth(Vec::new()).whole(&triangle_rotary("natural"));
    assert!(none.iter().all(Vec::is_empty));
}

#[test]
fn analytic_velocities_are_the_rates() {
    let columns = smooth(times(&[0.01, 0.02, 0.005]));
    let found = columns.whole(&Analytic);
    assert_eq!(found[0], columns.rates[0]);
    assert_eq!(found[1], columns.rates[1]);
    for (found, exact) in found[2].iter().zip(&columns.rates[2]) {
        assert!((found - exact).abs() < 1e-14);
    }
}

/// The effect on the slopes of rounding values up to 4. Chords take it divided by the shortest step
/// of a whole of 1. An end that is not a knot multiplies it by its extrapolation, (h₀ + h₁)/h₁.
fn noise(steps: &[f64], total: f64, ends: &str) -> f64 {
    let shortest = steps
        .iter()
        .fold(f64::INFINITY, |least, step| step.min(least))
        / total;
    let count = steps.len();
    let reach = match (ends, count) {
        ("not-a-knot", 2..) => {
            let (first, last) = (steps[0] / steps[1], steps[count - 1] / steps[count - 2]);
            1.0 + first.max(last)
        }
        _ => 1.0,
    };
    16.0 * f64::EPSILON * reach / shortest
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    /// Every end condition reproduces what it admits, from few nodes and on steps up to 1 : 1000:
    /// clamped and not-a-knot ends a cubic, natural ends a straight line.
    #[test]
    fn splines_reproduce_cubics_and_lines(
        exponents in prop::collection::vec(-1.5..1.5f64, 1..40),
        c in prop::array::uniform4(-1.0..1.0f64),
    ) {
        let steps: Vec<f64> = exponents.iter().map(|e| Scalar::powf(10.0, *e)).collect();
        let total: f64 = steps.iter().sum();
        let t: Vec<f64> = times(&steps).iter().map(|t| t / total).collect();
        for ends in BOUNDARIES {
            let order = match (ends, t.len()) {
                ("natural", _) => 1,
                ("not-a-knot", count) => (count - 1).min(3),
                _ => 3,
            };
            let term = |k: usize| if k <= order { c[k] } else { 0.0 };
            let value = |t: &f64| term(0) + t * (term(1) + t * (term(2) + t * term(3)));
            let rate = |t: &f64| term(1) + t * (2.0 * term(2) + t * 3.0 * term(3));
            let values: Vec<f64> = t.iter().map(value).collect();
            let rates: Vec<f64> = t.iter().map(rate).collect();
            let columns = Columns {
                t: t.clone(),
                values: [t.clone(), values.clone(), values],
                rates: [vec![1.0; t.len()], rates.clone(), rates],
            };
            let found = columns.whole(&triangle_rotary(ends));
            let allowed = noise(&steps, total, ends);
            for (found, exact) in found.iter().zip(&columns.rates) {
                let off = worst(found, exact);
                prop_assert!(off < allowed, "{}: {:e} of {:e}", ends, off, allowed);
            }
        }
    }
}
