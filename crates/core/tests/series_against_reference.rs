//! The elementary functions on Taylor series against mpmath (tests/reference/series.py).

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;
use turnpath_core::{Dual, Lanes, ORDER, Scalar, Series, Taylor};

/// Bound of each coefficient, relative to the coefficient itself.
const RELATIVE: f64 = 1e-12;

fn cases() -> Vec<Value> {
    let text = include_str!("../../../tests/reference/series.json");
    let made: Value = serde_json::from_str(text).unwrap();
    made["cases"].as_array().unwrap().clone()
}

fn series(value: &Value) -> Series {
    serde_json::from_value(value.clone()).unwrap()
}

fn apply<S: Scalar>(function: &str, a: S, b: S) -> S {
    match function {
        "recip" => a.recip(),
        "sqrt" => a.sqrt(),
        "exp" => a.exp(),
        "ln" => a.ln(),
        "sin" => a.sin(),
        "cos" => a.cos(),
        "tan" => a.tan(),
        "asin" => a.asin(),
        "acos" => a.acos(),
        "atan" => a.atan(),
        "sinh" => a.sinh(),
        "cosh" => a.cosh(),
        "tanh" => a.tanh(),
        "powf 2.5" => a.powf(2.5),
        "powf -0.75" => a.powf(-0.75),
        "powi 5" => a.powi(5),
        "powi -3" => a.powi(-3),
        "abs" => a.abs(),
        "mul" => a * b,
        "div" => a / b,
        "hypot" => a.hypot(b),
        "atan2" => a.atan2(b),
        other => panic!("the reference has a function `{other}` that this test does not know"),
    }
}

/// The case's name and its arguments; the second is 0 where the function has one.
fn arguments(case: &Value) -> (&str, Series, Series) {
    let b = case.get("b").map_or([0.0; ORDER + 1], series);
    (case["function"].as_str().unwrap(), series(&case["a"]), b)
}

#[test]
fn every_function_agrees_with_50_digits() {
    for case in cases() {
        let (function, a, b) = arguments(&case);
        let ours = apply(function, Taylor(a), Taylor(b)).0;
        let reference = series(&case["out"]);
        for k in 0..=ORDER {
            let error = (ours[k] - reference[k]).abs();
            assert!(
                error <= RELATIVE * reference[k].abs(),
                "{function} of {a:?}, {b:?}: coefficient {k} is {}, reference {}, relative {:e}",
                ours[k],
                reference[k],
                error / reference[k].abs()
            );
        }
    }
}

/// Duals whose derivative is the curve's own give, in each coefficient, that of the derivative.
#[test]
fn duals_within_a_series_are_the_derivative_of_the_series() {
    let slope = |c: Series| [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0];
    for case in cases() {
        let (function, a, b) = arguments(&case);
        let dual = |c: Series| -> Taylor<Dual<f64>> {
            let rate = slope(c);
            Taylor(std::array::from_fn(|k| Dual {
                value: c[k],
                dx: rate[k],
                dy: 0.0,
            }))
        };
        let nested = apply(function, dual(a), dual(b)).0;
        let reference = series(&case["out"]);
        let alone = apply(function, Taylor(a), Taylor(b)).0;
        for (k, nested) in nested.iter().enumerate().take(ORDER) {
            let expected = slope(reference)[k];
            assert_eq!((nested.value, nested.dy), (alone[k], 0.0), "{function}");
            assert!(
                (nested.dx - expected).abs() <= RELATIVE * expected.abs(),
                "{function} of {a:?}, {b:?}: {k}: {} for {expected}",
                nested.dx
            );
        }
    }
}

#[test]
fn each_lane_is_bit_for_bit_what_its_number_gives_alone() {
    let cases = cases();
    for case in &cases {
        let (function, a, b) = arguments(case);
        let lane = |c: Series, i: usize| c.map(|c| c * (1.0 + 0.03 * i as f64));
        let lanes = |c: Series| -> Taylor<Lanes<4>> {
            Taylor(std::array::from_fn(|k| {
                Lanes::<4>(std::array::from_fn(|i| lane(c, i)[k]))
            }))
        };
        let together = apply(function, lanes(a), lanes(b)).0;
        for i in 0..4 {
            let alone = apply(function, Taylor(lane(a, i)), Taylor(lane(b, i))).0;
            for k in 0..=ORDER {
                let same = together[k].0[i].to_bits() == alone[k].to_bits();
                assert!(
                    same || alone[k].is_nan(),
                    "{function}, lane {i}, coefficient {k}"
                );
            }
        }
    }
}

#[test]
fn lanes_choose_each_for_itself() {
    let a = Lanes([-1.0, 2.0, f64::NAN, 0.0]);
    let b = Lanes([1.0, -2.0, 0.5, 0.0]);
    assert_eq!(a.min(b).0[..2], [-1.0, -2.0]);
    assert_eq!(a.max(b).0[..2], [1.0, 2.0]);
    assert_eq!(a.less(b).0, [true, false, false, false]);
    assert_eq!(a.abs().0[0], 1.0);
}

#[test]
fn outside_the_domain_is_not_a_number() {
    let t = |value| Taylor([value, 1.0, 0.0, 0.0, 0.0]);
    assert!(t(-1.0).ln().0[0].is_nan());
    for outside in [
        t(-1.0).sqrt(),
        t(1.5).asin(),
        t(-1.5).acos(),
        t(-2.0).powf(0.5),
    ] {
        assert!(outside.0.iter().all(|c| c.is_nan()));
    }
}

#[test]
fn whole_powers_have_their_derivatives_at_zero() {
    let t = Taylor([0.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(t.powi(3).0, [0.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!(t.powi(1).0, t.0);
    assert_eq!(t.powi(0).0, [1.0, 0.0, 0.0, 0.0, 0.0]);
}

/// cosh is not finite from 711 on, and tanh is smooth.
#[test]
fn tanh_is_smooth_however_large_its_argument() {
    for size in [1e2, 1e3, 1e6, 1e300] {
        for u in [size, -size] {
            let rate = Taylor([u, 360.0, 25.0, -3.0, 7.0]);
            let series = rate.tanh().0;
            assert_eq!(series[0], u.signum(), "tanh {u}");
            let of_dual = Taylor(rate.0.map(|value| Dual {
                value,
                dx: 360.0,
                dy: -360.0,
            }));
            let nested = of_dual.tanh().0;
            for k in 0..=ORDER {
                let Dual { value, dx, dy } = nested[k];
                assert_eq!(value, series[k], "tanh {u}: {k}");
                for small in [if k == 0 { 0.0 } else { series[k] }, dx, dy] {
                    assert!(small.abs() < 1e-70, "tanh {u}: {k}: {small}");
                }
            }
            let dual = Dual::variable_x(u).tanh();
            assert!(dual.dx < 1e-80 && dual.dy == 0.0, "tanh {u}: {dual:?}");
        }
    }
}
