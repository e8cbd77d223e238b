//! The interpolation error against the remainder of cubic interpolation and known figures.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use crate::common::{AST5, SPEED, astigmatic_path, figures, touch_on};
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{DEG, NM, Scalar, Surface};
use turnpath_verify::Meter;

const STEP: f64 = 9.0 * DEG;

/// Runs of segments.
const FIRST: Range<usize> = 0..1;
const FOUR: Range<usize> = 0..4;
const WHOLE: Range<usize> = 0..300;
const NONE: Range<usize> = 5..5;

const RIM: f64 = 2.5;

/// The turn at the rim of AST-5, in steps of 9 deg with exact velocities.
#[test]
fn one_turn_of_ast_5_has_the_known_errors() {
    for (nose, known) in [(0.0, 12.507), (1.0, 30.436)] {
        let turn = astigmatic_path(AST5, nose, 40, STEP, |_| (RIM, 0.0));
        let touch = touch_on(AST5, RIM, 1.0, nose > 0.0);
        let found = figures(&touch, &turn).playback.max() / NM;
        assert!((found - known).abs() < 5e-3, "{found} nm");
    }
}

/// A spiral with the feed of the contact law, 24.7 µm, which ends at the rim.
#[test]
fn a_spiral_over_ast_5_has_the_known_errors() {
    let feed = RIM / 101.11;
    let steps = (101.11 * 40.0) as usize;
    let law = |theta: f64| (feed * theta / TAU, feed / TAU);
    for (nose, known) in [(0.0, 12.46), (1.0, 30.22)] {
        let spiral = astigmatic_path(AST5, nose, steps, STEP, law);
        let touch = touch_on(AST5, RIM, 1.0, nose > 0.0);
        let found = figures(&touch, &spiral).playback.max() / NM;
        assert!((found / known - 1.0).abs() < 3e-3, "{found} nm");
    }
}

/// h⁴/384·|φ⁗| with φ = k X² sin 2θ, at fine and coarse steps.
#[test]
fn the_error_is_the_remainder_of_cubic_interpolation() {
    for degrees in [3.0, 6.0, 10.0] {
        let step = degrees * DEG;
        let steps = (360.0 / degrees) as usize;
        let turn = astigmatic_path(AST5, 0.0, steps, step, |_| (RIM, 0.0));
        let touch = touch_on(AST5, RIM, 1.0, false);
        let found = figures(&touch, &turn).playback;
        let bound = 16.0 * AST5.k * RIM * RIM * (step * step * step * step) / 384.0;
        assert!((found.max() / bound - 1.0).abs() < 0.02, "{degrees} deg");
        assert!(found.max() <= bound);
        // s⁴(1 − s)⁴ has the mean 1/630, and sin² the mean 1/2.
        let rms = bound * (256.0f64 / 630.0 / 2.0).sqrt();
        assert!((found.rms() / rms - 1.0).abs() < 0.01, "{degrees} deg");
    }
}

/// A Z that is too high by 5 nm at one node is reported with amount, sign and position.
#[test]
fn a_wrong_node_is_found_with_sign_and_position() {
    let mut turn = astigmatic_path(AST5, 0.0, 360, DEG, |_| (RIM, 0.0));
    turn.z[200] += 5.0 * NM;
    let found = figures(&touch_on(AST5, RIM, 1.0, false), &turn).playback;
    assert!((found.extreme / NM - 5.0).abs() < 0.01);
    assert!((found.at_c - 200.0 * DEG).abs() < 0.05 * DEG);
    assert_eq!(found.at_x, RIM);
}

/// An error whose top is not in the middle of its segment has the top between instants.
#[test]
fn the_top_of_a_lopsided_error_is_found_between_instants() {
    let mut turn = astigmatic_path(AST5, 0.0, 360, DEG, |_| (RIM, 0.0));
    // A wrong slope m at one node gives m h s(1 − s)², 4/27 m h high, one third from the node.
    turn.vz[90] += 1e-3;
    let found = figures(&touch_on(AST5, RIM, 1.0, false), &turn).playback;
    let top = 4.0 / 27.0 * 1e-3 * DEG / SPEED;
    assert!((found.max() / top - 1.0).abs() < 2e-3);
}

/// A roof with a ridge along x. On its way round, the nose meets the ridge at C = 0, and comes down again at once.
struct Roof {
    slope: f64,
}

impl Surface for Roof {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, _: S, y: S) -> S {
        -(y.squared() + 1e-30).sqrt() * self.slope
    }
}

/// Z of the nose over the roof, mm, and its rate with C.
fn over_roof(slope: f64, c: f64) -> [f64; 2] {
    let (sin, cos) = Scalar::sin_cos(c);
    let slant = (1.0 + slope * slope * sin * sin).sqrt();
    let z = -slope * RIM * sin.abs() + NOSE * slant;
    let rate = -slope * RIM * cos * c.signum() + NOSE * slope * slope * sin * cos / slant;
    [z, rate]
}

const NOSE: f64 = 1.0;

/// Where the ridge lies in a segment: between two instants, on one, and near the ends.
const RIDGES: [f64; 7] = [
    5.5 / 16.0,
    0.3,
    0.51,
    8.0 / 16.0,
    1.4 / 16.0,
    0.6 / 16.0,
    15.5 / 16.0,
];

/// A segment over the ridge of a roof, and its error by the closed form, mm, at a time from 0 to 1.
fn over_ridge(slope: f64, place: f64) -> (PathBlock, impl Fn(f64) -> f64) {
    let ends = [-place * STEP, (1.0 - place) * STEP];
    let nodes = ends.map(|c| (c, over_roof(slope, c)));
    let mut points = PathBlock::default();
    for (c, [z, rate]) in nodes {
        points.push(ControlPoint {
            t: (c - ends[0]) / SPEED,
            c,
            x: RIM,
            z,
            vc: SPEED,
            vx: 0.0,
            vz: rate * SPEED,
        });
    }
    let [(_, [z0, r0]), (_, [z1, r1])] = nodes;
    let error = move |s: f64| {
        let u = 1.0 - s;
        let by_places = z0 * u * u * (1.0 + 2.0 * s) + z1 * s * s * (1.0 + 2.0 * u);
        let by_rates = STEP * s * u * (r0 * u - r1 * s);
        by_places + by_rates - over_roof(slope, ends[0] + s * STEP)[0]
    };
    (points, error)
}

/// The largest |error| of ten thousand places, mm.
fn largest(error: impl Fn(f64) -> f64) -> f64 {
    let each = (0..=10_000).map(|k| error(f64::from(k) * 1e-4).abs());
    each.fold(0.0, f64::max)
}

/// A segment over a ridge, which lies anywhere between two instants, against ten thousand places of the closed form.
#[test]
fn the_top_over_a_ridge_is_found_between_instants() {
    let slope = 2e-3;
    let touch = touch_on(Roof { slope }, RIM, NOSE, true);
    for place in RIDGES {
        let (points, error) = over_ridge(slope, place);
        let largest = largest(error);
        let found = figures(&touch, &points).playback.max();
        assert!(
            (found / largest - 1.0).abs() < 4e-3,
            "{place}: {found} for {largest}"
        );
    }
}

/// An error against limits need not be the largest one, but it lies where that lies: beside each limit, and between
/// two of them.
#[test]
fn an_error_against_limits_lies_on_the_side_of_the_top_over_a_ridge() {
    let slope = 2e-3;
    let touch = touch_on(Roof { slope }, RIM, NOSE, true);
    for place in RIDGES {
        let (points, error) = over_ridge(slope, place);
        let largest = largest(error);
        let of = |limits: &[f64]| {
            let found = Meter::errors_against(&touch, &points, &[FIRST], limits).unwrap();
            let sides = limits.iter().map(|limit| found[0] > *limit);
            assert!(
                sides.eq(limits.iter().map(|limit| largest > *limit)),
                "{place}: {found:?} for {largest} against {limits:?}"
            );
            found[0]
        };
        for part in [0.1, 0.5, 0.7, 0.9, 0.99, 1.01, 1.1, 1.5, 10.0] {
            of(&[part * largest]);
            of(&[0.75 * part * largest, part * largest]);
        }
        let exact = Meter::segment_errors(&touch, &points).unwrap();
        assert_eq!(of(&[0.99 * largest, 1.01 * largest]), exact[0]);
        assert!(of(&[10.0 * largest]) <= exact[0]);
    }
}

#[test]
fn an_error_in_the_middle_is_that_of_the_closed_form_and_below_the_top() {
    let slope = 2e-3;
    let touch = touch_on(Roof { slope }, RIM, NOSE, true);
    for place in RIDGES {
        let (points, error) = over_ridge(slope, place);
        let found = Meter::errors_at_middles(&touch, &points, &[FIRST]).unwrap();
        assert!((found[0] - error(0.5).abs()).abs() < 1e-12, "{place}");
        assert!(found[0] <= Meter::segment_errors(&touch, &points).unwrap()[0]);
    }
}

/// Segments over the ridge, which the path crosses once a turn.
fn turns_over_roof(slope: f64, segments: usize) -> PathBlock {
    let mut points = PathBlock::default();
    for k in 0..=segments {
        let c = (k as f64 + 0.3) * STEP;
        // C of the nearest crossing is 0 here.
        let from_ridge = c - PI * (c / PI).round();
        let [z, rate] = over_roof(slope, from_ridge);
        points.push(ControlPoint {
            t: c / SPEED,
            c,
            x: RIM,
            z,
            vc: SPEED,
            vx: 0.0,
            vz: rate * SPEED,
        });
    }
    points
}

/// Runs of a block have the errors that they have in the whole block, over ridges and beside them.
#[test]
fn errors_of_runs_are_those_of_the_block() {
    let slope = 2e-3;
    let (touch, points) = (
        touch_on(Roof { slope }, RIM, NOSE, true),
        turns_over_roof(slope, 300),
    );
    let all = Meter::segment_errors(&touch, &points).unwrap();
    let tops = all.iter().filter(|error| **error > 10.0 * NM).count();
    assert_eq!(tops, 15, "{all:?}");
    let limits = [10.0 * NM, 1e3 * NM];
    let side = |error: &f64| limits.map(|limit| *error > limit);
    for runs in [
        &[WHOLE][..],
        &[0..1, 7..200, 250..251, 299..300],
        &[NONE],
        &[],
    ] {
        let numbers = || runs.iter().cloned().flatten();
        let found = Meter::errors_against(&touch, &points, runs, &limits).unwrap();
        let expected = numbers().map(|number| side(&all[number]));
        assert!(found.iter().map(side).eq(expected), "{runs:?}");
        let middles = Meter::errors_at_middles(&touch, &points, runs).unwrap();
        assert_eq!(middles.len(), found.len());
        for (middle, number) in middles.into_iter().zip(numbers()) {
            assert!(middle <= all[number] + 1e-12, "{number}: {middle}");
        }
    }
}

/// From the middle itself no touch is found, and that says nothing of the segment.
#[test]
fn a_middle_without_a_touch_decides_nothing() {
    let mut turn = astigmatic_path(AST5, 0.0, 4, DEG, |_| (RIM, 0.0));
    turn.z[2] = f64::NAN;
    let touch = touch_on(AST5, RIM, 1.0, false);
    let middles = Meter::errors_at_middles(&touch, &turn, &[FOUR]).unwrap();
    assert_eq!(middles[1..3], [0.0; 2]);
    let errors = Meter::errors_against(&touch, &turn, &[FOUR], &[NM]).unwrap();
    assert_eq!(errors[1..3], [f64::INFINITY; 2]);
}

#[test]
fn where_z_is_nan_the_error_is_infinite() {
    let mut turn = astigmatic_path(AST5, 0.0, 360, DEG, |_| (RIM, 0.0));
    turn.z[100] = f64::NAN;
    let found = figures(&touch_on(AST5, RIM, 1.0, false), &turn).playback;
    assert_eq!(found.max(), f64::INFINITY);
    assert!((found.at_c - 99.5 * DEG).abs() < DEG);
}
