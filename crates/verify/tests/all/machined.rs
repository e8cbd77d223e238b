//! The machined surface against closed forms.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::common::{
    AST5, Astigmatic, Ball, Paraboloid, Plane, Pocket, SPEED, astigmatic_path, touch_of, touch_on,
};
use turnpath_core::toolpath::{ControlPoint, PathBlock, Segment};
use turnpath_core::{DEG, Misfit, NM, Scalar, Tool};
use turnpath_verify::machined::{
    FormScope, Grid, MachinedFigures, Map, Nose, ProfileLine, SpectrumLine, power_spectrum,
};
use turnpath_verify::{FirstTouch, Meter};

fn machined(touch: &FirstTouch, points: &PathBlock) -> MachinedFigures {
    let mut meter = Meter::new(touch.clone());
    let block = Meter::measure(touch, points).expect("figures");
    meter.append(block).expect("figures");
    meter.machined().expect("figures").expect("a cut")
}

/// A spiral from `beyond` feeds on the other side of the axis to as many feeds beyond the rim. Z
/// and its slope depend on X alone.
fn spiral(feed: f64, rim: f64, beyond: f64, z: impl Fn(f64) -> (f64, f64)) -> PathBlock {
    let mut points = PathBlock::default();
    let turns = rim / feed + 2.0 * beyond;
    for i in 0..=(turns * 72.0) as usize {
        let n = i as f64 / 72.0;
        let x = feed * (n - beyond);
        let (z, slope) = z(x);
        let vx = feed * SPEED / TAU;
        points.push(ControlPoint {
            t: n * TAU / SPEED,
            c: n * TAU,
            x,
            z,
            vc: SPEED,
            vx,
            vz: slope * vx,
        });
    }
    points
}

/// The path of the contact over z = k ρ² sin 2θ at these angles, with exact rates. `law` gives X and
/// dX/dθ at θ.
fn contact_path(
    surface: Astigmatic,
    angles: impl Iterator<Item = f64>,
    law: impl Fn(f64) -> (f64, f64),
) -> PathBlock {
    let mut points = PathBlock::default();
    for theta in angles {
        let (x, rate) = law(theta);
        let (sin, cos) = Scalar::sin_cos(2.0 * theta);
        points.push(ControlPoint {
            t: theta / SPEED,
            c: theta,
            x,
            z: surface.k * x * x * sin,
            vc: SPEED,
            vx: rate * SPEED,
            vz: surface.k * (2.0 * x * rate * sin + 2.0 * x * x * cos) * SPEED,
        });
    }
    points
}

#[test]
fn a_flat_part_is_left_with_the_scallop_of_the_closed_form() {
    let (radius, feed, rim) = (1.0, 0.02, 5.0);
    let touch = touch_on(Plane { slope: 0.0 }, rim, radius, true);
    let found = machined(&touch, &spiral(feed, rim, 2.0, |_| (radius, 0.0)));
    let scallop = feed * feed / (8.0 * radius);
    assert!(
        (found.highest.error / scallop - 1.0).abs() < 0.01,
        "{found:?}"
    );
    assert!((found.pv() / scallop - 1.0).abs() < 0.01);
    assert!(found.lowest.error.abs() < 1e-5 * scallop);
    assert!(
        (found.mean / (scallop / 3.0) - 1.0).abs() < 0.01,
        "{found:?}"
    );
    assert!(
        (found.rms / (scallop * (0.2f64).sqrt()) - 1.0).abs() < 0.01,
        "{found:?}"
    );
    assert!((found.sq / (scallop * (4.0f64 / 45.0).sqrt()) - 1.0).abs() < 0.01);
    // |u² − 1/3| on 0 … 1: 4/(9√3).
    assert!((found.sa / (scallop * 4.0 / (9.0 * 3f64.sqrt())) - 1.0).abs() < 0.01);
    let slope = 0.5 * feed / radius / 3f64.sqrt();
    assert!((found.rms_slope / slope - 1.0).abs() < 0.01);
    assert_eq!(found.uncut, 0.0);
}

#[test]
fn a_path_of_the_contact_leaves_what_the_path_of_the_centre_leaves() {
    let (feed, rim) = (0.02, 5.0);
    let centre = touch_on(Plane { slope: 0.0 }, rim, 1.0, true);
    let contact = touch_on(Plane { slope: 0.0 }, rim, 1.0, false);
    let of_centre = machined(&centre, &spiral(feed, rim, 2.0, |_| (1.0, 0.0)));
    let of_contact = machined(&contact, &spiral(feed, rim, 2.0, |_| (0.0, 0.0)));
    assert!((of_centre.rms - of_contact.rms).abs() < 1e-15);
    assert!((of_centre.pv() - of_contact.pv()).abs() < 1e-15);
}

#[test]
fn a_path_that_is_too_high_leaves_its_height() {
    let touch = touch_on(Plane { slope: 0.0 }, 5.0, 1.0, true);
    let high = 100.0 * NM;
    let found = machined(&touch, &spiral(0.001, 5.0, 2.0, |_| (1.0 + high, 0.0)));
    assert!((found.mean / high - 1.0).abs() < 0.01);
    assert!(found.sq < 0.01 * high);
    assert!(found.pv() < 0.2 * NM);
}

/// The centres lie on a sphere of radius `ball` − R, the passes at equal distances in X.
#[test]
fn in_a_ball_the_cusps_are_those_of_circles_on_a_circle() {
    let (ball, nose, feed, rim) = (10.0f64, 1.0f64, 0.05, 2.0);
    let touch = touch_on(Ball { radius: ball }, rim, nose, true);
    let centres = ball - nose;
    let law = |x: f64| {
        let depth = (centres * centres - x * x).sqrt();
        (ball - depth, x / depth)
    };
    let found = machined(&touch, &spiral(feed, rim, 3.0, law));
    // The highest cusp is at the rim, between two centres on the circle that are a feed apart in X.
    let cusp = |foot: f64| {
        let x = foot * centres / ball;
        let depth = (centres * centres - x * x).sqrt();
        let half = 0.5 * feed * centres / depth;
        let along = (centres * centres - half * half).sqrt() + (nose * nose - half * half).sqrt();
        (ball - along) * ball / (ball * ball - foot * foot).sqrt()
    };
    let (expected, least) = (cusp(rim), cusp(0.0));
    assert!(
        (found.highest.error / expected - 1.0).abs() < 0.01,
        "{found:?} {expected:e}"
    );
    assert!(found.lowest.error.abs() < 0.01 * least, "{found:?}");
    let middle = 0.5 * (least + expected);
    assert!(
        (found.rms / (middle * 0.2f64.sqrt()) - 1.0).abs() < 0.01,
        "{found:?} {middle:e}"
    );
    assert_eq!(found.uncut, 0.0);
}

/// The rim has a slope of 82 degrees. The centres follow a circle of radius r = `ball` − R at equal distances.
/// A tip lies at the distance d = r cos(δ/2) + √(R² − r² sin²(δ/2)) from the ball's centre, where δ is the angle
/// between two passes. No pass cuts into the ball.
#[test]
fn in_a_steep_ball_nothing_is_cut_below_it() {
    let (ball, nose, step) = (0.5f64, 0.1f64, 0.024f64);
    let steepest = 82.0 * DEG;
    let rim = ball * Scalar::sin_cos(steepest).0;
    let touch = touch_on(Ball { radius: ball }, rim, nose, true);
    let centres = ball - nose;
    let mut points = PathBlock::default();
    for i in 0..=((steepest / step + 4.0) * 24.0) as usize {
        let n = i as f64 / 24.0;
        let (sin, cos) = Scalar::sin_cos(step * (n - 2.0));
        let rate = centres * step * SPEED / TAU;
        points.push(ControlPoint {
            t: n * TAU / SPEED,
            c: n * TAU,
            x: centres * sin,
            z: ball - centres * cos,
            vc: SPEED,
            vx: rate * cos,
            vz: rate * sin,
        });
    }
    let found = machined(&touch, &points);
    assert!(found.lowest.error.abs() < 0.01 * NM, "{found:?}");
    let (sin, cos) = Scalar::sin_cos(0.5 * step);
    let tip = centres * cos + (nose * nose - centres * centres * sin * sin).sqrt();
    let expected = (ball * ball - rim * rim).sqrt() - (tip * tip - rim * rim).sqrt();
    assert!(
        (found.highest.error / expected - 1.0).abs() < 0.01,
        "{found:?} {expected:e}"
    );
    assert_eq!(found.uncut, 0.0);
}

/// The contacts ρ of the passes are at equal distances f on z = ρ²/(2r). Along the normal the cusps
/// are f²w²(1 − Rκ)/(8R) high, with w = √(1 + (ρ/r)²) and κ = 1/(r w³). Along z they are w times as
/// high.
#[test]
fn in_a_paraboloid_the_cusps_are_those_of_its_slope_and_curvature() {
    let (vertex, nose, feed, rim) = (10.0f64, 1.0f64, 0.02, 5.0);
    let touch = touch_on(Paraboloid { radius: vertex }, rim, nose, true);
    let width = |rho: f64| (1.0 + (rho / vertex) * (rho / vertex)).sqrt();
    let gap = |rho: f64| 1.0 - nose / (vertex * width(rho) * width(rho) * width(rho));
    let mut points = PathBlock::default();
    let beyond = 3.0;
    for i in 0..=((rim / feed + 2.0 * beyond) * 72.0) as usize {
        let n = i as f64 / 72.0;
        let rho = feed * (n - beyond);
        let slope = rho / vertex;
        let (w, rate) = (width(rho), feed * SPEED / TAU * gap(rho));
        points.push(ControlPoint {
            t: n * TAU / SPEED,
            c: n * TAU,
            x: rho - nose * slope / w,
            z: 0.5 * rho * slope + nose / w,
            vc: SPEED,
            vx: rate,
            vz: slope * rate,
        });
    }
    let found = machined(&touch, &points);
    let w = width(rim);
    let expected = feed * feed * w * w * gap(rim) / (8.0 * nose) * w;
    assert!(
        (found.pv() / expected - 1.0).abs() < 0.02,
        "{found:?} {expected:e}"
    );
    let rho = Scalar::hypot(found.highest.x, found.highest.y);
    assert!(rho > rim - feed, "{found:?}");
    assert_eq!(found.uncut, 0.0);
}

/// A coarse path of the contact over z = k ρ² sin 2θ with exact rates leaves L⁴/384 · |φ⁗|, which
/// is 16 k ρ² L⁴/384. A turn has a whole number of steps, so the error is the same on all turns.
/// The largest |φ⁗| lies in the middle of a step. The feed leaves cusps of half a per cent of the
/// error.
#[test]
fn a_coarse_path_leaves_the_bound_of_its_fourth_derivative() {
    let surface = Astigmatic { k: 0.02 };
    let (rim, feed, steps) = (5.0, 0.002, 24usize);
    let touch = touch_on(surface, rim, 1.0, false);
    let step = TAU / steps as f64;
    let turns = rim / feed + 2.0;
    let count = (turns * steps as f64) as usize;
    let angles = (0..=count).map(|i| step * (i as f64 + 0.5));
    let law = |theta: f64| (feed * (theta / TAU - 1.0), feed / TAU);
    let points = contact_path(surface, angles, law);
    let found = machined(&touch, &points);
    let bound = 16.0 * surface.k * rim * rim * Scalar::powi(step, 4) / 384.0;
    for point in [found.highest, found.lowest] {
        let rho = Scalar::hypot(point.x, point.y);
        assert!(rho > 0.98 * rim, "{point:?}");
        let here = bound * (rho / rim) * (rho / rim);
        assert!(
            (point.error.abs() / here - 1.0).abs() < 0.02,
            "{point:?}, {here:e}"
        );
    }
}

#[test]
fn a_path_that_stops_short_leaves_the_rim_higher_or_uncut() {
    let touch = touch_on(Plane { slope: 0.0 }, 5.0, 1.0, true);
    let short = machined(&touch, &spiral(0.02, 4.5, 0.5, |_| (1.0, 0.0)));
    // The last pass lies 0.5 mm short of the rim, where its circle has risen by 1 − √0.75.
    let expected = 1.0 - 0.75f64.sqrt();
    assert!(
        (short.highest.error / expected - 1.0).abs() < 0.06,
        "{short:?}"
    );
    assert_eq!(short.uncut, 0.0);
    let shorter = machined(&touch, &spiral(0.02, 2.0, 0.5, |_| (1.0, 0.0)));
    assert!(
        (shorter.uncut - (1.0 - 9.0 / 25.0)).abs() < 0.01,
        "{shorter:?}"
    );
}

#[test]
fn blocks_give_what_one_piece_gives() {
    let touch = touch_on(AST5, 2.5, 1.0, true);
    let law = |theta: f64| (2.5 - 0.025 * theta / TAU, -0.025 / TAU);
    let points = astigmatic_path(AST5, 1.0, 99 * 40, 9.0 * DEG, law);
    let whole = machined(&touch, &points);
    let mut meter = Meter::new(touch.clone());
    let all: Vec<ControlPoint> = points.points().collect();
    for range in [0..100, 99..101, 100..1234, 1233..all.len()] {
        let mut block = PathBlock::default();
        all[range].iter().for_each(|point| block.push(*point));
        let figures = Meter::measure(&touch, &block).expect("figures");
        meter.append(figures).expect("figures");
    }
    assert_eq!(meter.machined().expect("figures"), Some(whole));
}

fn map_of(touch: &FirstTouch, grid: Grid, blocks: &[PathBlock], error: f64) -> Vec<f32> {
    let mut map = Map::new(grid, touch.subject().part);
    let nose = Nose::new(touch, error);
    for block in blocks {
        map.cut(&nose, block).expect("a cut");
    }
    (0..grid.rows())
        .flat_map(|row| map.row(row).collect::<Vec<_>>())
        .collect()
}

/// A path in pieces that overlap by one point.
fn pieces(points: &PathBlock, length: usize) -> Vec<PathBlock> {
    let all: Vec<ControlPoint> = points.points().collect();
    let block = |begin: usize| {
        let mut block = PathBlock::default();
        let end = (begin + length + 1).min(all.len());
        all[begin..end].iter().for_each(|point| block.push(*point));
        block
    };
    (0..all.len() - 1).step_by(length).map(block).collect()
}

/// The lowest of all passes over a point, for a path whose C runs evenly in steps of 9 deg.
fn brute_force(touch: &FirstTouch, segments: &[Segment], x: f64, y: f64) -> f64 {
    let (rho, angle) = (Scalar::hypot(x, y), Scalar::atan2(y, x));
    let mut lowest = f64::INFINITY;
    for half_turn in -1..=200 {
        let c = angle + 0.5 * TAU * f64::from(half_turn);
        let step = c / (9.0 * DEG);
        let Some(segment) = segments.get(step.floor().max(0.0) as usize) else {
            break;
        };
        if c < 0.0 {
            continue;
        }
        let side = if half_turn % 2 == 0 { rho } else { -rho };
        let off = side - segment.x.value(step - step.floor());
        if off.abs() < 1.0 {
            lowest = lowest.min(segment.z.value(step - step.floor()) - (1.0 - off * off).sqrt());
        }
    }
    let mut wanted = [0.0];
    let surface = &touch.subject().surface;
    surface.heights(&[x], &[y], &mut wanted).expect("a height");
    lowest - wanted[0]
}

#[test]
fn maps_agree_with_the_lowest_of_all_passes() {
    let law = |theta: f64| (2.9 - 0.03 * theta / TAU, -0.03 / TAU);
    let points = astigmatic_path(AST5, 1.0, 98 * 40, 9.0 * DEG, law);
    let segments: Vec<Segment> = points.segments().collect();
    let touch = touch_on(AST5, 2.5, 1.0, true);
    for grid in [
        Grid::cartesian(&touch.subject().part, 41),
        Grid::polar(&touch.subject().part, 20, 30),
    ] {
        let whole = map_of(&touch, grid, std::slice::from_ref(&points), 100.0 * NM);
        let in_pieces = map_of(&touch, grid, &pieces(&points, 170), 100.0 * NM);
        let all_passes = map_of(&touch, grid, std::slice::from_ref(&points), f64::INFINITY);
        assert_eq!(format!("{whole:?}"), format!("{in_pieces:?}"));
        assert_eq!(format!("{whole:?}"), format!("{all_passes:?}"));
        let mut compared = 0;
        for row in 0..grid.rows() {
            for column in 0..grid.columns() {
                let found = f64::from(whole[row * grid.columns() + column]);
                let (x, y) = grid.point(row, column);
                if Scalar::hypot(x, y) > 2.5 {
                    assert!(found.is_nan());
                    continue;
                }
                let expected = brute_force(&touch, &segments, x, y);
                assert!(
                    (found - expected).abs() < 1e-5 * NM + 1e-7 * expected,
                    "{x} {y}: {found:e} {expected:e}"
                );
                compared += 1;
            }
        }
        assert!(compared > 500);
    }
}

/// For a path of the contact, the nearest passes give the same map as all passes, and the map has
/// the same figures as the lines.
#[test]
fn maps_of_contact_paths_agree_with_figures() {
    let surface = Astigmatic { k: 0.02 };
    let touch = touch_on(surface, 2.5, 1.0, false);
    let law = |theta: f64| (2.6 - 0.03 * theta / TAU, -0.03 / TAU);
    let angles = (0..=88 * 40).map(|i| 9.0 * DEG * f64::from(i));
    let points = contact_path(surface, angles, law);
    let figures = machined(&touch, &points);
    let grid = Grid::polar(&touch.subject().part, 200, 97);
    let near = map_of(&touch, grid, std::slice::from_ref(&points), 100.0 * NM);
    let all = map_of(&touch, grid, &pieces(&points, 333), f64::INFINITY);
    assert_eq!(format!("{near:?}"), format!("{all:?}"));
    let (mut area, mut squares) = (0.0, 0.0);
    for (i, error) in near.iter().enumerate() {
        let ring = (i / 97) as f64 + 0.5;
        area += ring;
        squares += ring * f64::from(*error) * f64::from(*error);
        assert!(f64::from(*error) <= figures.highest.error * 1.0001);
        assert!(f64::from(*error) >= figures.lowest.error * 1.0001);
    }
    let rms = (squares / area).sqrt();
    assert!(
        (rms / figures.rms - 1.0).abs() < 0.02,
        "{rms:e} {:e}",
        figures.rms
    );
}

#[test]
fn a_profile_has_the_feed_as_its_period() {
    let (feed, rim) = (0.02, 5.0);
    let touch = touch_on(Plane { slope: 0.0 }, rim, 1.0, true);
    let path = spiral(feed, rim, 2.0, |_| (1.0, 0.0));
    let mut line = ProfileLine::new(30.0 * DEG);
    for block in pieces(&path, 1000) {
        line.append(&touch, &block).expect("passes");
    }
    let points = line.points(&touch).expect("points");
    let errors: Vec<f64> = points.iter().map(|point| point.error).collect();
    let highest = errors.iter().copied().fold(0.0, f64::max);
    assert!((highest / (feed * feed / 8.0) - 1.0).abs() < 0.01);
    let spectrum = power_spectrum(&errors, points[1].s - points[0].s);
    let higher = |a: &&SpectrumLine, b: &&SpectrumLine| a.density.total_cmp(&b.density);
    let top = spectrum.iter().max_by(higher).expect("a line");
    assert!((top.frequency * feed - 1.0).abs() < 0.01, "{top:?}");
}

/// A pocket as wide as a feed lies on one of the lines. No extreme is measured without it, whatever
/// the nose, and whether or not seams are left.
#[test]
fn a_place_of_the_part_without_a_height_is_an_error_that_names_it() {
    let (rim, feed) = (2.0, 0.05);
    // The first line of the fan through the axis: 0.37 of a section of 736.
    let (sin, cos) = Scalar::sin_cos(0.37 * TAU / 736.0);
    let pocket = |radius| Pocket {
        x: 1.2 * cos,
        y: 1.2 * sin,
        radius,
    };
    let measured = |radius, misfit, compensates: bool| {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit,
        };
        let touch = touch_of(pocket(radius), rim, tool, compensates);
        let height = if compensates { 1.0 } else { 0.0 };
        let path = spiral(feed, rim, 2.0, |_| (height, 0.0));
        let mut meter = Meter::new(touch.clone()).with_form(Some(FormScope {
            covers_part: true,
            covers_centre: true,
        }));
        meter
            .append(Meter::measure(&touch, &path).expect("figures"))
            .expect("figures");
        let pv = meter.form().map(|form| form.map(|form| form.pv()));
        [
            pv,
            meter.machined().map(|found| found.map(|found| found.pv())),
        ]
    };
    let cases = [
        (Misfit::Refuse, true),
        (Misfit::Refuse, false),
        (Misfit::CutWhatFits, true),
    ];
    for (misfit, compensates) in cases {
        for found in measured(0.0, misfit, compensates) {
            let scallop = feed * feed / 8.0;
            let pv = found.expect("a height everywhere").expect("a cut");
            assert!((pv / scallop - 1.0).abs() < 0.02, "{pv:e}");
        }
        for found in measured(0.5 * feed, misfit, compensates) {
            let message = found.expect_err("a pocket").to_string();
            // The first of the places on the line that lie in the pocket.
            assert!(message.contains("at x = 1.1"), "{message}");
            assert!(message.contains(" mm, y = 0.003"), "{message}");
        }
    }
}
