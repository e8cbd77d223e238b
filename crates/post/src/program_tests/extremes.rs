//! Points of any size come back.

use super::numbers::Numbers;
use super::*;
use crate::POSTS;

/// Blocks of points on whole steps of time, so that nothing moves them: their numbers come back to
/// half a digit, whatever their size.
fn extreme_points_come_back(layout: &Layout, seed: u64, blocks: usize) {
    let steps_per_s = layout.format.steps_per_s;
    let format = &layout.format;
    let of_digit = 0.5 / 10u64.pow(format.position_decimals) as f64;
    let half = |size: f64| of_digit + 2.0 * f64::EPSILON * size.abs();
    for block in 0..blocks as u64 {
        let mut numbers = Numbers(seed + block);
        let (mut steps, mut c) = (0i64, numbers.of_any_size(1e6));
        let points: Vec<ControlPoint> = (0..1000)
            .map(|_| {
                let point = ControlPoint {
                    t: steps as f64 / steps_per_s as f64,
                    c: c * DEG,
                    x: numbers.of_any_size(4e8),
                    z: numbers.of_any_size(4e8),
                    vc: numbers.of_any_size(4e8) * DEG,
                    vx: numbers.of_any_size(4e8),
                    vz: numbers.of_any_size(4e8),
                };
                let longest = layout.format.longest.min(10 * steps_per_s);
                steps += 1 + (numbers.part() * (longest - 1) as f64) as i64;
                // The controller takes the shorter way where C is wrapped.
                let most = if layout.format.c_wrapped {
                    179.0
                } else {
                    359.0
                };
                c += most * numbers.part() + 1e-3;
                point
            })
            .collect();
        let read = read(layout, program(layout, &points).as_bytes()).unwrap();
        assert_eq!(read.len(), points.len());
        let left_out = layout.turns_left_out(&points[0]).unwrap() / DEG;
        for (k, (one, other)) in points.iter().zip(&read).enumerate() {
            assert!((one.t - other.t).abs() <= 2.0 * f64::EPSILON * one.t);
            let duration = points[k.max(1)].t - points[k.max(1) - 1].t;
            let of_coefficients = coefficient_rounding(layout, duration);
            // A program of straight lines has no velocities.
            let said = if format.chords.is_some() { 3 } else { 6 };
            let held = |size: f64| format.held_rounding(size).unwrap_or(0.0);
            let c = other.c / DEG + left_out;
            let pairs = [
                (one.c / DEG, c, held(one.c / DEG)),
                (one.x, other.x, held(one.x)),
                (one.z, other.z, held(one.z)),
                (one.vc / DEG, other.vc / DEG, of_coefficients),
                (one.vx, other.vx, of_coefficients),
                (one.vz, other.vz, of_coefficients),
            ];
            for (one, other, more) in pairs.into_iter().take(said) {
                assert!((one - other).abs() <= half(one) + more, "{one} {other}");
            }
        }
    }
}

#[test]
fn points_of_any_size_come_back_to_half_a_digit() {
    for post in POSTS {
        extreme_points_come_back(&plain(post), 1, 10);
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_million_points_of_any_size_come_back_to_half_a_digit() {
    for post in POSTS {
        extreme_points_come_back(&plain(post), 1_000_000, 1000);
    }
}
