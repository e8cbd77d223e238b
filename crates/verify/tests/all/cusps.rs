//! The residual against closed forms.

use crate::common::{AST5, Ball, Plane, astigmatic_locus, bare_spiral, figures, touch_on};
use turnpath_core::{DEG, NM, Scalar};
use turnpath_verify::cusp_heights;

/// The depth below the crest where two circles of radius 1 meet whose centres are `apart`.
fn cusp(apart: f64) -> f64 {
    1.0 - (1.0 - 0.25 * apart * apart).sqrt()
}

#[test]
fn on_a_flat_part_cusps_are_the_feed_squared_over_8_r() {
    for (compensates, feed) in [(true, 0.028), (false, 0.028), (true, 0.005)] {
        let touch = touch_on(Plane { slope: 0.0 }, 2.5, 1.0, compensates);
        let spiral = bare_spiral(2.4 / feed, |n| feed * n);
        let found = figures(&touch, &spiral).residual.max;
        assert!((found / (feed * feed / 8.0) - 1.0).abs() < 0.01);
        assert!((found - cusp(feed)).abs() < 1e-14);
    }
}

#[test]
fn on_a_tilted_plane_cusps_are_measured_along_its_normal() {
    let (feed, touch) = (0.02, touch_on(Plane { slope: 1.0 }, 2.5, 1.0, true));
    let spiral = bare_spiral(100.0, |n| feed * n);
    let found = figures(&touch, &spiral).residual;
    assert!((found.max - cusp(feed * 2f64.sqrt())).abs() < 1e-13);
    let steepest = found.at_theta.min((found.at_theta - 180.0 * DEG).abs());
    assert!(steepest < 1e-12);
}

#[test]
fn in_a_ball_passes_at_equal_angles_leave_the_known_cusp() {
    // The centres lie on a ball of radius 0.25, one angle apart.
    let (ball, angle) = (1.25f64, 0.05);
    let centres = ball - 1.0;
    let touch = touch_on(Ball { radius: ball }, 1.05, 1.0, true);
    let spiral = bare_spiral(18.0, |n| centres * Scalar::sin(angle * n));
    let found = figures(&touch, &spiral).residual.max;
    let half = centres * Scalar::sin(0.5 * angle);
    let exact = ball - (centres * centres - half * half).sqrt() - (1.0 - half * half).sqrt();
    assert!((found - exact).abs() < 1e-13, "{found} {exact}");
}

#[test]
fn passes_that_do_not_meet_leave_an_infinite_residual() {
    let touch = touch_on(Plane { slope: 0.0 }, 2.5, 0.05, true);
    let spiral = bare_spiral(20.0, |n| 0.11 * n);
    let found = figures(&touch, &spiral).residual;
    assert_eq!(found.max, f64::INFINITY);
    assert!(found.at_rho > 0.0 && found.at_rho < 2.5);
}

#[test]
fn a_path_of_less_than_a_turn_has_no_cusps() {
    let touch = touch_on(Plane { slope: 0.0 }, 2.5, 1.0, true);
    let found = figures(&touch, &bare_spiral(0.9, |n| n)).residual;
    assert_eq!((found.cusps, found.max), (0, 0.0));
}

/// The smallest feed over all angles that leaves 100 nm on AST-5 under a nose of 1 mm. The law of
/// the centre takes κ and w at the foot, the law of the contact takes them at X itself.
fn smallest_feed(of_centre: bool, x: f64) -> f64 {
    let feed = |degrees: usize| {
        let theta = DEG * degrees as f64;
        let bend = 2.0 * AST5.k * Scalar::sin(2.0 * theta);
        let slope = match of_centre {
            true => astigmatic_locus(AST5, 1.0, theta, x)[2],
            false => bend * x,
        };
        let w = (1.0 + slope * slope).sqrt();
        let gap = 1.0 - bend / (w * w * w);
        let squared = if of_centre { gap } else { 1.0 / gap };
        (8.0 * 100.0 * NM * squared).sqrt() / w
    };
    (0..180).map(feed).fold(f64::INFINITY, f64::min)
}

/// X as a function of revolutions, for dX/dN = the smallest feed at X.
fn spiral_with(of_centre: bool) -> impl Fn(f64) -> f64 {
    let (step, mut x) = (0.25, 0.0);
    let mut table = vec![x];
    while x < 2.5 {
        let half = x + 0.5 * step * smallest_feed(of_centre, x);
        x += step * smallest_feed(of_centre, half);
        table.push(x);
    }
    move |n: f64| {
        let position = (n / step).max(0.0);
        let k = (position as usize).min(table.len() - 2);
        table[k] + (position - k as f64) * (table[k + 1] - table[k])
    }
}

#[test]
fn on_ast_5_the_law_of_the_centre_leaves_the_tolerance_and_that_of_the_contact_more() {
    let touch = touch_on(AST5, 2.5, 1.0, true);
    for (of_centre, turns, known) in [(true, 98.5, 100.0), (false, 97.5, 105.0)] {
        let spiral = bare_spiral(turns, spiral_with(of_centre));
        let found = figures(&touch, &spiral).residual.max / NM;
        assert!((found - known).abs() < 0.5, "{found} nm");
    }
}

#[test]
fn single_cusps_are_those_of_the_closed_form_where_they_stand_on_the_part() {
    let touch = touch_on(Plane { slope: 1.0 }, 2.5, 1.0, true);
    let (theta, off) = ([0.0, 90.0 * DEG, 0.0], [0.0, 0.0, 3.0]);
    let pairs = off.map(|off| [1.0 + off, 1.02 + off]);
    let found = cusp_heights(&touch, &theta, &pairs).unwrap();
    let exact = [Some(cusp(0.02 * 2f64.sqrt())), Some(cusp(0.02)), None];
    for (found, exact) in found.iter().zip(exact) {
        let near = |exact: f64| found.is_some_and(|found| (found - exact).abs() < 1e-13);
        assert!(exact.map_or(found.is_none(), near), "{found:?} {exact:?}");
    }
}
