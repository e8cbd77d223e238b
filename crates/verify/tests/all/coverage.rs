//! Coverage of rim, hole and centre against closed forms.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::common::{AST5, Ball, Plane, bare_spiral, figures, touch_of, touch_on};
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{DEG, Misfit, Part, Scalar, Tool, UM};
use turnpath_verify::{CoverageFigures, FirstTouch, Meter, PathFigures, Subject};

const FLAT: Plane = Plane { slope: 0.0 };
/// A plane of 45 degrees.
const TILTED: Plane = Plane { slope: 1.0 };

fn coverage(touch: &FirstTouch, path: &PathBlock) -> CoverageFigures {
    figures(touch, path).coverage
}

/// The figures with the cusps around the axis counted as residual.
fn with_centre(touch: &FirstTouch, path: &PathBlock) -> PathFigures {
    let mut meter = Meter::new(touch.clone()).counting_centre(true);
    let block = Meter::measure(touch, path).unwrap();
    meter.append(block).unwrap();
    meter.figures().unwrap()
}

/// The distance of a nose of 1 mm from a point of a flat, `away` from the contact.
fn left_at(away: f64) -> f64 {
    (1.0 + away * away).sqrt() - 1.0
}

/// The height of a nose of 1 mm above a point of a flat, `away` from the contact.
fn rise(away: f64) -> f64 {
    1.0 - (1.0 - away * away).sqrt()
}

/// The cusp between two contacts of a nose of 1 mm on a flat.
fn cusp(apart: f64) -> f64 {
    1.0 - (1.0 - 0.25 * apart * apart).sqrt()
}

#[test]
fn at_the_rim_of_a_flat_the_last_pass_leaves_the_rise_of_its_circle() {
    let (feed, turns) = (0.02, 120.0);
    let outward = bare_spiral(turns, |n| feed * n);
    let inward = bare_spiral(turns, |n| feed * (turns - n));
    // Just after the end of an outward spiral, the last pass lies a turn further in. So does the
    // first pass just before the start of an inward one.
    for path in [outward, inward] {
        for compensates in [true, false] {
            let touch = touch_on(FLAT, 2.5, 1.0, compensates);
            let rim = coverage(&touch, &path).rim.unwrap();
            assert!((rim.height - rise(2.5 - feed * turns + feed)).abs() < 1e-13);
            assert!(rim.at_theta.min(TAU - rim.at_theta) < 1e-9);
        }
    }
}

/// Between sections: a path ends anywhere, and the height jumps there.
#[test]
fn the_jump_at_the_rim_is_found_where_the_path_ends() {
    let (feed, touch) = (0.02, touch_on(FLAT, 2.5, 1.0, true));
    for part in [0.15, 0.4, 0.65, 0.9] {
        let turns = 120.0 + part / 60.0;
        let outward = spiral_to(turns, |n| feed * n);
        let rim = coverage(&touch, &outward).rim.unwrap();
        let known = rise(2.5 - feed * (turns - 1.0));
        assert!((rim.height - known).abs() < 1e-12, "{part}: {rim:?}");
        assert!((rim.at_theta - TAU * part / 60.0).abs() < 1e-9, "{rim:?}");
    }
}

/// A straight spiral whose last step is as short as its length asks.
fn spiral_to(turns: f64, x: impl Fn(f64) -> f64) -> PathBlock {
    let mut points = bare_spiral(turns, &x);
    let whole = points.get(points.len() - 1).unwrap();
    let share = turns * TAU - whole.c;
    points.push(ControlPoint {
        t: whole.t + share / whole.vc,
        c: turns * TAU,
        x: x(turns),
        ..whole
    });
    points
}

#[test]
fn on_a_slope_the_rim_is_measured_from_the_surface_not_along_z() {
    let (feed, touch) = (0.02, touch_on(TILTED, 2.5, 1.0, false));
    let rim = coverage(&touch, &bare_spiral(122.5, |n| feed * n))
        .rim
        .unwrap();
    // The path ends at 180 degrees. There, or a degree on, the last pass lies a turn further in.
    let known = left_at(2f64.sqrt() * (0.05 + feed));
    assert!((rim.height / known - 1.0).abs() < 1e-9);
    assert!((rim.at_theta - 180.0 * DEG).abs() < 1e-9);
}

/// Where the wall rises outward, the normal through the machined point at the rim has its foot
/// beyond the rim, farther from the contact.
#[test]
fn on_a_rising_wall_the_machined_point_at_the_rim_counts() {
    let feed = 0.02;
    for slope in [0.2, 1.0, 2.0] {
        let touch = touch_on(Plane { slope }, 2.5, 1.0, false);
        let path = bare_spiral(122.0, |n| feed * n);
        let rim = coverage(&touch, &path).rim.unwrap();
        let away = (1.0f64 + slope * slope).sqrt() * (2.5 - feed * 121.0);
        // A height h above the wall at the rim stands h·slope further up the wall.
        let known = (0..200).fold(0.0, |height, _| rise(away + slope * height));
        assert!((rim.height / known - 1.0).abs() < 1e-6, "{rim:?}, {known}");
        assert!(known > left_at(away));
        assert!(rim.at_theta.min(TAU - rim.at_theta) < 1e-9);
    }
    // The nose ends 0.05 mm beyond its contact, and the rim lies 0.08 mm beyond.
    let touch = touch_on(Plane { slope: 3.0 }, 2.5, 1.0, false);
    let rim = coverage(&touch, &bare_spiral(122.0, |n| feed * n))
        .rim
        .unwrap();
    assert_eq!(rim.height, f64::INFINITY);
}

/// A path that ends at X = a touches AST-5 only out to 2.17 mm where the surface falls outward. The
/// rim itself lies 67 um below the nose.
#[test]
fn a_path_to_the_aperture_leaves_67_um_at_the_rim_of_ast_5() {
    let feed = 1e-4;
    let touch = touch_on(AST5, 2.5, 1.0, true);
    let path = bare_spiral(1100.0, |n| 2.5 - feed * n);
    let rim = coverage(&touch, &path).rim.unwrap();
    assert!((rim.height / UM - 67.3).abs() < 0.05, "{}", rim.height / UM);
    let from_valley = (rim.at_theta - 315.0 * DEG).abs();
    assert!(from_valley < 1.5 * DEG, "{}", rim.at_theta / DEG);
}

/// Within a degree, X from which the nose touches the rim of AST-5 moves by up to seven of these
/// feeds. Wherever the rim is, a pass lies within half a feed of it, so no more than a cusp stays.
#[test]
fn a_rim_whose_contact_moves_by_many_feeds_a_degree_keeps_no_more_than_a_cusp() {
    let feed = 2e-3;
    let touch = touch_on(AST5, 2.5, 1.0, true);
    let path = bare_spiral(400.0, |n| 2.874 - feed * n);
    let rim = coverage(&touch, &path).rim.unwrap();
    // The cusp is the highest where the rim rises outward by 0.4, hollow with 0.16/mm. The contact
    // there moves by feed / (1 − κR) along x, and the cusp of a nose of 1 mm is (1 − κR)s²/8.
    let slant: f64 = 1.0 + 0.4 * 0.4;
    let hollow = 0.16 / (slant * slant.sqrt());
    let cusp = feed * feed * slant / (8.0 * (1.0 - hollow));
    assert!((rim.height / cusp - 1.0).abs() < 0.01, "{rim:?}, {cusp}");
}

#[test]
fn passes_of_the_opposite_half_count_where_they_reach() {
    // The path stands still at X = −0.3 on one half. It cuts the opposite rim of a part of 0.3 mm.
    let touch = touch_on(FLAT, 0.3, 1.0, true);
    let rim = coverage(&touch, &bare_spiral(2.0, |_| -0.3)).rim.unwrap();
    assert!(rim.height < 1e-15);
}

#[test]
fn an_edge_that_no_pass_reaches_has_an_infinite_uncut_height() {
    let narrow = |degrees: f64| Tool {
        nose_radius: 1.0,
        included_angle: Some(degrees * DEG),
        clearance_angle: None,
        misfit: Misfit::Refuse,
    };
    let path = bare_spiral(121.0, |n| 0.02 * n);
    // From the pass at 2.4 mm to the rim: within sin 6 degrees, beyond sin 5.
    let reached = coverage(&touch_of(FLAT, 2.5, narrow(12.0), true), &path);
    assert!((reached.rim.unwrap().height - rise(0.1)).abs() < 1e-13);
    let missed = coverage(&touch_of(FLAT, 2.5, narrow(10.0), true), &path);
    assert_eq!(missed.rim.unwrap().height, f64::INFINITY);
}

#[test]
fn a_path_of_less_than_a_turn_covers_nothing_all_around() {
    let touch = touch_on(FLAT, 2.5, 1.0, true);
    let found = coverage(&touch, &bare_spiral(0.9, |n| n));
    assert_eq!(found.rim.unwrap().height, f64::INFINITY);
    assert_eq!(found.centre.unwrap().height, f64::INFINITY);
}

#[test]
fn at_a_hole_the_innermost_pass_leaves_the_rise_of_its_circle() {
    let touch = FirstTouch::new(Subject {
        part: Part {
            aperture_radius: 2.5,
            inner_radius: 1.0,
        },
        ..touch_on(FLAT, 2.5, 1.0, true).subject().clone()
    })
    .unwrap();
    let found = coverage(&touch, &bare_spiral(70.0, |n| 2.5 - 0.02 * n));
    assert_eq!(found.centre, None);
    // A turn before the path's end at 1.1 mm.
    let hole = found.hole.unwrap().height;
    assert!((hole - rise(0.12)).abs() < 1e-12, "{hole}");
}

/// Sections are a degree apart, so the widest measured gap is that of a degree before it closes.
#[test]
fn a_spiral_that_ends_at_the_axis_leaves_a_gap_of_one_and_a_half_feeds() {
    let feed = 0.02;
    for compensates in [true, false] {
        let touch = touch_on(FLAT, 2.5, 1.0, compensates);
        let path = bare_spiral(100.0, |n| feed * n);
        let found = figures(&touch, &path);
        let centre = found.coverage.centre.unwrap();
        let known = cusp(feed * (1.5 - 1.0 / 180.0));
        assert!((centre.height - known).abs() < 1e-14);
        assert!((centre.at_theta - 179.0 * DEG).abs() < 1e-12);
        assert!((found.residual.max - cusp(feed)).abs() < 1e-14);
        let counted = with_centre(&touch, &path).residual;
        assert_eq!(counted.max, centre.height);
        assert!(counted.cusps > found.residual.cusps);
        let inward = bare_spiral(100.0, |n| feed * (100.0 - n));
        let gap = coverage(&touch, &inward).centre.unwrap().height;
        assert!((gap / cusp(1.5 * feed) - 1.0).abs() < 0.01, "{gap}");
    }
}

#[test]
fn a_turn_on_the_axis_closes_the_gap() {
    let feed = 0.02;
    let touch = touch_on(FLAT, 2.5, 1.0, true);
    let path = bare_spiral(101.0, |n| feed * (n - 1.0).max(0.0));
    let found = with_centre(&touch, &path);
    // With sixty points a turn, the kink is played a thousandth of a feed off.
    let centre = found.coverage.centre.unwrap().height;
    assert!((centre / cusp(feed) - 1.0).abs() < 3e-3);
    assert_eq!(found.residual.max, centre);
}

/// The axis then lies between many turns, whose passes from both sides halve the gaps.
#[test]
fn a_path_that_runs_on_beyond_the_axis_is_judged_at_the_axis() {
    let feed = 0.02;
    let touch = touch_on(FLAT, 2.5, 1.0, true);
    for path in [
        bare_spiral(130.0, |n| 2.4 - feed * n),
        bare_spiral(130.0, |n| feed * (n - 10.0)),
        bare_spiral(240.0, |n| 2.4 - feed * n),
    ] {
        let found = with_centre(&touch, &path);
        let centre = found.coverage.centre.unwrap().height;
        assert!(centre <= 1.0001 * cusp(feed), "{centre}");
        assert!((found.residual.max / cusp(feed) - 1.0).abs() < 1e-4);
    }
}

#[test]
fn around_the_axis_of_a_tilted_plane_cusps_are_those_between_contacts() {
    let feed = 0.02;
    let touch = touch_on(TILTED, 1.0, 1.0, true);
    // With normal compensation the contact's radius grows evenly, and X lies beside it.
    let path = bare_spiral(50.0, |n| {
        let slope = Scalar::cos(std::f64::consts::TAU * n);
        feed * n - slope / (1.0 + slope * slope).sqrt()
    });
    let found = coverage(&touch, &path);
    let slope = Scalar::cos(179.0 * DEG);
    let gap = feed * (1.5 - 1.0 / 180.0) * (1.0 + slope * slope).sqrt();
    let height = found.centre.unwrap().height;
    // With sixty points a turn, the bent X is played to some micrometres.
    assert!((height / cusp(gap) - 1.0).abs() < 1e-3, "{height}");
    let beyond = 0.5f64.sqrt();
    assert!((found.x_beyond_axis - beyond).abs() < 1e-3 * beyond);
    assert!(found.contact_beyond_axis < 1e-3 * feed);
}

/// On this slope the contacts around the axis come from passes 0.7 mm away from it.
#[test]
fn around_the_axis_of_a_tilted_plane_the_innermost_turns_count_wherever_they_touch() {
    let feed = 0.02;
    let touch = touch_on(TILTED, 2.5, 1.0, true);
    let centre = |path: PathBlock| coverage(&touch, &path).centre.unwrap().height;
    let known = cusp(2f64.sqrt() * 1.5 * feed);
    let ends = centre(bare_spiral(100.0, |n| feed * n));
    assert!(ends < 1.01 * known, "{ends} of {known}");
    let crosses = centre(bare_spiral(150.0, |n| 2.0 - feed * n));
    assert!(crosses < 1.01 * cusp(2f64.sqrt() * feed), "{crosses}");
}

/// Where X moves within the turn, fast angles reach the axis many turns before slow ones, and are
/// far beyond it when the path ends. The widest gap is the feed of the fastest angle.
#[test]
fn each_line_is_judged_by_the_turns_that_meet_on_it() {
    let feed = 0.02;
    for harmonic in [1.0, 2.0] {
        let rate = |n: f64| feed * (1.0 + 0.3 * Scalar::sin(harmonic * TAU * n));
        let inward = bare_spiral(180.0, |n| 2.5 - rate(n) * n);
        let outward = bare_spiral(180.0, |n| rate(n) * n - 0.5);
        for path in [inward, outward] {
            let touch = touch_on(FLAT, 2.5, 1.0, true);
            let height = coverage(&touch, &path).centre.unwrap().height;
            assert!(height < 1.01 * cusp(1.3 * feed), "{height}, {harmonic}");
            assert!(height > cusp(0.65 * feed), "{height}, {harmonic}");
        }
    }
}

#[test]
fn a_path_that_ends_before_the_axis_leaves_it_uncut() {
    let touch = touch_on(FLAT, 2.5, 0.2, true);
    let path = bare_spiral(20.0, |n| 0.5 + 0.02 * n);
    let centre = coverage(&touch, &path).centre.unwrap();
    assert_eq!(centre.height, f64::INFINITY);
}

#[test]
fn a_start_beyond_the_axis_is_reported_with_its_contact() {
    let beyond = 12.3 * UM;
    let ball = touch_on(Ball { radius: 4.0 }, 1.0, 1.0, true);
    let path = bare_spiral(30.0, |n| 0.02 * n - beyond);
    let found = coverage(&ball, &path);
    assert!((found.x_beyond_axis - beyond).abs() < 1e-12);
    // The contact lies four thirds as far out as the centre.
    assert!((found.contact_beyond_axis - beyond * 4.0 / 3.0).abs() < 1e-9);
    let flat = coverage(&ball, &bare_spiral(30.0, |n| 0.02 * n));
    assert_eq!((flat.x_beyond_axis, flat.contact_beyond_axis), (0.0, 0.0));
}
