//! Parts into which the nose does not fit: the material that stays, and the cusps above it, against
//! plane geometry.

use std::f64::consts::{PI, TAU};

use crate::common::{Groove, Plane, bare_spiral, figures, touch_of};
use turnpath_core::{DEG, Misfit, Part, Scalar, Surface, Tool};
use turnpath_verify::{FirstTouch, Subject, rides, unreached};

const NOSE: f64 = 0.5;

/// A ring-shaped groove with straight flanks: z = slope · |ρ − radius|.
struct Ring {
    slope: f64,
    radius: f64,
}

impl Surface for Ring {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let off = (x.squared() + y.squared() + 1e-24).sqrt() - self.radius;
        (off.squared() + 1e-24).sqrt() * self.slope
    }
}

fn tool(included_angle: Option<f64>) -> Tool {
    Tool {
        nose_radius: NOSE,
        included_angle,
        clearance_angle: None,
        misfit: Misfit::CutWhatFits,
    }
}

fn ring(slope: f64) -> FirstTouch {
    touch_of(Ring { slope, radius: 1.0 }, 1.6, tool(None), true)
}

fn close(value: f64, expected: f64, part: f64) {
    let off = value / expected - 1.0;
    assert!(off.abs() < part, "{value} against {expected}: {off:e}");
}

#[test]
fn in_a_ring_groove_the_material_between_circle_and_flanks_stays() {
    for slope in [0.02, 0.3, 1.0] {
        let w = (1.0 + slope * slope).sqrt();
        let contact = NOSE * slope / w;
        let bottom = NOSE * w;
        let threshold = 0.3 * (bottom - NOSE);
        let found = unreached(&ring(slope), threshold).expect("figures");
        close(found.height, bottom - NOSE, 1e-6);
        assert!((found.at_rho.abs() - 1.0).abs() < 1e-6);
        let under_circle = contact * NOSE / w + NOSE * NOSE * Scalar::atan(slope);
        let area = 2.0 * bottom * contact - slope * contact * contact - under_circle;
        close(found.volume, area * TAU, 2e-3);
        let b = bottom - threshold;
        let root = b * b * slope * slope - w * w * (b * b - NOSE * NOSE);
        let half_width = (b * slope - root.sqrt()) / (w * w);
        close(
            found.area_fraction,
            2.0 * half_width * TAU / (PI * 2.56),
            5e-3,
        );
    }
}

#[test]
fn in_a_straight_groove_across_the_axis_the_sum_over_all_sections_stays() {
    let slope = 0.4;
    let groove = Groove {
        slope,
        width: 1e-12,
    };
    let found = unreached(&touch_of(groove, 1.0, tool(None), true), 1.0).expect("figures");
    let section = |theta: f64| {
        let m = slope * Scalar::cos(theta).abs();
        let w = (1.0 + m * m).sqrt();
        let c = NOSE * m / w;
        let lift = NOSE / w;
        let cap = (NOSE * NOSE * NOSE - lift * lift * lift) / 3.0;
        2.0 * (0.5 * NOSE * w * c * c - cap - m * c * c * c / 3.0)
    };
    let sum: f64 = (0..10_000).map(|i| section(PI * f64::from(i) / 1e4)).sum();
    close(found.volume, sum * PI / 1e4, 5e-3);
    let w = (1.0f64 + slope * slope).sqrt();
    close(found.height, NOSE * (w - 1.0), 1e-5);
    assert_eq!(found.area_fraction, 0.0);
}

#[test]
fn on_a_rim_or_a_hole_only_what_lies_on_the_part_counts() {
    let slope = 0.3;
    let half = touch_of(Ring { slope, radius: 1.0 }, 1.0, tool(None), true);
    let (whole, half) = (
        unreached(&ring(slope), 1.0).expect("figures").volume,
        unreached(&half, 1.0).expect("figures").volume,
    );
    // The inner half of the section, its centroid a little nearer to the axis.
    assert!(
        half < 0.5 * whole && half > 0.46 * whole,
        "{half} of {whole}"
    );
}

#[test]
fn a_nose_that_fits_leaves_nothing() {
    let found = unreached(
        &touch_of(Plane { slope: 0.5 }, 4.0, tool(Some(120.0 * DEG)), true),
        0.0,
    );
    assert_eq!(
        found.expect("figures"),
        turnpath_verify::UnreachedFigures::default()
    );
}

/// Two passes at equal distances on either side of the seam stand higher by half the feed times the
/// slope. Their cusp adds the height of a cusp on a flat.
#[test]
fn over_a_seam_cusps_are_measured_from_what_the_nose_can_reach() {
    let (slope, feed) = (0.3, 0.01);
    let spiral = bare_spiral(30.0, |n| 0.85 + feed * n);
    let found = figures(&ring(slope), &spiral).residual;
    let flat = NOSE - (NOSE * NOSE - 0.25 * feed * feed).sqrt();
    close(found.max, 0.5 * slope * feed + flat, 1e-4);
    assert!((found.at_rho - 1.0).abs() < 0.01);
}

/// A ring groove lies on the rim. At best the nose stands over it, with its lowest point R(w − 1)
/// above the bottom. A pass `away` from it stands higher by the rise of the flank and of its
/// circle.
#[test]
fn a_groove_through_a_rim_is_uncut_from_what_the_nose_can_reach() {
    for slope in [0.02, 0.3, 1.0] {
        let left = |away: f64| {
            let up = slope * away + NOSE;
            (up * up + away * away).sqrt() - NOSE
        };
        let feed = 0.01;
        let ring = || Ring { slope, radius: 1.0 };
        let rim = touch_of(ring(), 1.0, tool(None), true);
        // The outermost pass of each section lies on the groove, or up to a feed inside of it.
        let path = bare_spiral(3.0, |n| 1.0 - feed * (3.0 - n));
        let found = figures(&rim, &path).coverage.rim.expect("a rim");
        close(found.height, left(feed), 1e-4);
        // A turn that stays on the groove cuts all that the nose can cut.
        let path = bare_spiral(4.0, |n| (0.98 + feed * n).min(1.0));
        let found = figures(&rim, &path).coverage.rim.expect("a rim");
        assert!(found.height < 1e-9, "{}", found.height);
        let hole = Part {
            aperture_radius: 1.6,
            inner_radius: 1.0,
        };
        let subject = Subject {
            part: hole,
            ..rim.subject().clone()
        };
        let touch = FirstTouch::new(subject).expect("a touch");
        let path = bare_spiral(3.0, |n| 1.0 + feed * n);
        let found = figures(&touch, &path).coverage.hole.expect("a hole");
        close(found.height, left(feed * 359.0 / 360.0), 1e-2);
    }
}

/// Where the nose comes down to the rim beside a groove, heights count from the surface itself.
#[test]
fn a_rim_beside_a_groove_is_uncut_from_the_surface() {
    let (slope, feed) = (0.3, 0.01);
    let path = bare_spiral(3.0, |n| 1.6 - feed * (3.0 - n));
    let rim = |misfit: Misfit| {
        let tool = Tool {
            misfit,
            ..tool(None)
        };
        let touch = touch_of(Ring { slope, radius: 1.0 }, 1.6, tool, true);
        figures(&touch, &path).coverage.rim.expect("a rim").height
    };
    close(rim(Misfit::CutWhatFits), rim(Misfit::Refuse), 1e-9);
}

/// A seam over a hole, or beyond the end of the path, does not matter.
#[test]
fn only_rides_of_the_path_that_reach_onto_the_part_are_reported() {
    let touch = |inner_radius: f64| {
        let subject = Subject {
            part: Part {
                aperture_radius: 1.6,
                inner_radius,
            },
            ..ring(0.3).subject().clone()
        };
        FirstTouch::new(subject).expect("a touch")
    };
    let contact = NOSE * 0.3 / 1.09f64.sqrt();
    let count = |inner: f64, outer: f64| rides(&touch(inner), outer).expect("rides").len();
    assert_eq!(count(0.0, 0.99), 0);
    assert_eq!(count(1.01 + contact, 1.6), 0);
    assert_eq!(count(0.99 + contact, 1.6), count(0.0, 1.6));
}

/// On a slope of 45 deg, an edge that ends at 30 deg cuts steps with its end.
#[test]
fn an_edge_that_ends_before_the_slope_leaves_steps() {
    let feed = 0.004;
    let touch = touch_of(Plane { slope: 1.0 }, 2.5, tool(Some(60.0 * DEG)), true);
    let found = figures(&touch, &bare_spiral(60.0, |n| 1.0 + feed * n)).residual;
    let end = 0.5 * NOSE - feed;
    let step = feed + NOSE * 0.75f64.sqrt() - (NOSE * NOSE - end * end).sqrt();
    close(found.max, step * 0.5f64.sqrt(), 1e-3);
}

/// On a ring groove with flanks of slope m the nose moves down at −m and up at m, with the corner
/// over the groove itself, on both sides of the axis.
#[test]
fn over_a_ring_groove_the_nose_turns_by_twice_the_slope() {
    for slope in [0.02, 0.3, 1.0] {
        let found = rides(&ring(slope), 1.6).expect("rides");
        assert!(found.len() > 100);
        for ride in found {
            assert!((ride.x.abs() - 1.0).abs() < 1e-6, "{}", ride.x);
            close(ride.corner, 2.0 * slope, 1e-5);
            assert!((0.0..PI).contains(&ride.theta));
        }
    }
}
