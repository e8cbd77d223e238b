//! Cusps as played, and what a real nose leaves along a path that takes its radius as 0, against
//! closed forms.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::f64::consts::{PI, TAU};

use crate::common::{Ball, Plane, SPEED, touch_on};
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{Part, Scalar};
use turnpath_verify::machined::MachinedFigures;
use turnpath_verify::{FirstTouch, Meter, PathFigures, Subject};

/// Control points on a turn.
const STEPS: f64 = 144.0;

fn measured(
    touch: &FirstTouch,
    points: &PathBlock,
    counts_centre: bool,
) -> (PathFigures, MachinedFigures) {
    let mut meter = Meter::new(touch.clone()).counting_centre(counts_centre);
    let block = Meter::measure(touch, points).expect("figures");
    meter.append(block).expect("figures");
    let machined = meter.machined().expect("figures").expect("a cut");
    (meter.figures().expect("figures"), machined)
}

/// A spiral over `turns` turns. X, Z and their slopes per turn depend on the turns.
fn spiral(turns: f64, at: impl Fn(f64) -> [f64; 4]) -> PathBlock {
    let mut points = PathBlock::default();
    for i in 0..=(turns * STEPS) as usize {
        let n = i as f64 / STEPS;
        let [x, z, x_slope, z_slope] = at(n);
        points.push(ControlPoint {
            t: n * TAU / SPEED,
            c: n * TAU,
            x,
            z,
            vc: SPEED,
            vx: x_slope * SPEED / TAU,
            vz: z_slope * SPEED / TAU,
        });
    }
    points
}

/// Passes on a flat that stand high and low by turns, by `wave`, with a nose of 1 mm.
fn waving(feed: f64, wave: f64, turns: f64) -> PathBlock {
    spiral(turns, |n| {
        let (sin, cos) = Scalar::sin_cos(PI * n);
        [feed * n, 1.0 + wave * cos, feed, -PI * wave * sin]
    })
}

/// Two circles of radius 1 that are a feed f apart, one 2δ higher, cross f²/8 + 2δ²/f² above the
/// mean of their lowest points. From δ = f²/4 on the higher one cuts nothing: the lower ones cross
/// f²/2 − δ above that mean. So f²/4 is the most that any δ leaves.
#[test]
fn passes_that_stand_high_and_low_leave_the_cusp_of_their_circles() {
    let feed = 0.02;
    let touch = FirstTouch::new(Subject {
        part: Part {
            aperture_radius: 2.0,
            inner_radius: 0.5,
        },
        ..touch_on(Plane { slope: 0.0 }, 2.0, 1.0, true)
            .subject()
            .clone()
    })
    .expect("a surface with heights");
    let square = feed * feed;
    for (wave, known) in [
        (0.0, 0.125 * square),
        (0.125 * square, (0.125 + 2.0 * 0.125 * 0.125) * square),
        (0.4 * square, 0.25 * square),
        (3.0 * square, 0.25 * square),
    ] {
        let (path, machined) = measured(&touch, &waving(feed, wave, 104.0), false);
        let cusp = machined.cusp.expect("a cusp");
        let apart = cusp.height / known - 1.0;
        assert!(apart.abs() < 5e-3, "{wave:e}: {cusp:?}, not {known:e}");
        // The residual is that of the true Z, whatever is played.
        assert!((path.residual.max / (0.125 * square) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn on_a_slope_a_cusp_as_played_is_measured_along_the_normal() {
    let (feed, slope) = (0.02, 1.0);
    let touch = touch_on(Plane { slope }, 1.0, 1.0, true);
    // The nose touches a plane at the same height above it, whatever the angle.
    let lift = |cos: f64| Scalar::sqrt(1.0 + slope * slope * cos * cos);
    let path = spiral(100.0, |n| {
        let (sin, cos) = Scalar::sin_cos(TAU * n);
        let x = feed * n;
        let rise = -slope * slope * cos * sin / lift(cos);
        let z = slope * x * cos + lift(cos);
        [
            x,
            z,
            feed,
            slope * (feed * cos - x * TAU * sin) + TAU * rise,
        ]
    });
    let (figures, machined) = measured(&touch, &path, false);
    let cusp = machined.cusp.expect("a cusp");
    let known = 1.0 - (1.0 - 0.5 * feed * feed).sqrt();
    assert!((cusp.height / known - 1.0).abs() < 2e-3, "{cusp:?}");
    assert!((cusp.height / figures.residual.max - 1.0).abs() < 2e-3);
}

/// A spiral that ends at the axis leaves 1.5 feeds between the two sides.
#[test]
fn the_gap_between_the_two_sides_of_the_axis_counts_where_the_path_covers_the_axis() {
    let feed = 0.02;
    let touch = touch_on(Plane { slope: 0.0 }, 1.0, 1.0, true);
    let path = waving(feed, 0.0, 52.0);
    let height = |counts| {
        let (_, machined) = measured(&touch, &path, counts);
        machined.cusp.expect("a cusp").height
    };
    let known = |feeds: f64| feeds * feeds * feed * feed / 8.0;
    assert!((height(false) / known(1.0) - 1.0).abs() < 1e-3);
    assert!((height(true) / known(1.5) - 1.0).abs() < 0.01);
}

/// Contacts on a tilted plane. The nose's lowest point is there, so its circle goes 1/cos a − 1
/// of its radius below the plane.
#[test]
fn on_a_tilted_plane_the_real_nose_gouges_by_the_closed_form() {
    for (slope, radius) in [(0.1, 1.0), (0.5, 0.3), (1.0, 1.0)] {
        let touch = touch_on(Plane { slope }, 2.0, radius, false);
        let feed = 0.01;
        let path = spiral(201.0, |n| {
            let (sin, cos) = Scalar::sin_cos(TAU * n);
            let x = feed * n;
            [
                x,
                slope * x * cos,
                feed,
                slope * (feed * cos - x * TAU * sin),
            ]
        });
        let (_, machined) = measured(&touch, &path, false);
        let nose = machined.real_nose.expect("a real nose");
        let known = radius * ((1.0 + slope * slope).sqrt() - 1.0);
        let gouge = -nose.lowest.error;
        assert!((gouge / known - 1.0).abs() < 1e-4, "{gouge:e}, {known:e}");
        assert!((nose.pv() - (nose.highest.error + gouge)).abs() < 1e-15);
        // Along the contour the nose lies on the plane but for its cusps.
        let most = (1.0 + slope * slope) * feed * feed / (2.0 * radius);
        assert!(nose.highest.error > 0.0 && nose.highest.error < most);
        assert!(nose.lowest.y.abs() < 0.01 * nose.lowest.x.abs());
    }
}

/// In a bowl, the circle of the contact at slope angle a touches its envelope at ρ + R sin a, at
/// R − R cos a above the contact.
#[test]
fn in_a_bowl_the_real_nose_gouges_at_the_rim_by_the_closed_form() {
    let (ball, radius, rim, feed): (f64, f64, f64, f64) = (10.0, 0.5, 3.0, 0.004);
    let touch = touch_on(Ball { radius: ball }, rim, radius, false);
    let depth = |rho: f64| (ball * ball - rho * rho).sqrt();
    let path = spiral((rim + 0.02) / feed, |n| {
        let x = feed * n;
        [x, ball - depth(x), feed, feed * x / depth(x)]
    });
    let (_, machined) = measured(&touch, &path, false);
    let nose = machined.real_nose.expect("a real nose");
    // sin a = ρ/ball: the contact whose circle reaches the rim.
    let rho = rim / (1.0 + radius / ball);
    let cut = ball - depth(rho) + radius * (1.0 - depth(rho) / ball);
    let known = ball - depth(rim) - cut;
    let gouge = -nose.lowest.error;
    assert!((gouge / known - 1.0).abs() < 2e-3, "{gouge:e}, {known:e}");
    let at = (nose.lowest.x * nose.lowest.x + nose.lowest.y * nose.lowest.y).sqrt();
    assert!(at > rim - 2.0 * feed, "{nose:?}");
}

#[test]
fn a_path_of_the_centre_has_no_other_real_nose() {
    let touch = touch_on(Plane { slope: 0.0 }, 1.0, 1.0, true);
    let (_, machined) = measured(&touch, &waving(0.02, 0.0, 52.0), false);
    assert_eq!(machined.real_nose, None);
}
