//! The first touch against closed forms, or against every point of the edge where no closed form
//! exists.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::{Ball, Groove, Plane, Trough, Waves, touch_of, touch_on, touches};
use turnpath_core::{DEG, Scalar, Surface, Tool};
use turnpath_verify::Touch;

const STEPS: usize = 40;

/// −limit to limit in [`STEPS`] steps.
fn positions(limit: f64) -> Vec<f64> {
    let position = |i| limit * (2.0 * i as f64 / STEPS as f64 - 1.0);
    (0..=STEPS).map(position).collect()
}

#[test]
fn in_a_ball_the_centre_is_on_a_smaller_ball() {
    let touch = touch_on(Ball { radius: 10.0 }, 8.0, 1.0, true);
    let x = positions(8.0);
    for (found, x) in touches(&touch, 0.7, &x).iter().zip(&x) {
        let height = (81.0 - x * x).sqrt();
        assert!((found.z - (10.0 - height)).abs() < 1e-14);
        assert!((found.foot - x * 10.0 / 9.0).abs() < 1e-7);
        assert!((found.slope - x / height).abs() < 1e-6);
    }
}

#[test]
fn on_a_ball_the_centre_is_on_a_larger_one_also_where_the_nose_hangs_over() {
    let touch = touch_on(Ball { radius: -5.0 }, 4.9, 1.0, true);
    assert!(!touch.has_single_maximum());
    let x = positions(4.9);
    for (found, x) in touches(&touch, 2.0, &x).iter().zip(&x) {
        assert!((found.z - ((36.0 - x * x).sqrt() - 5.0)).abs() < 1e-14);
    }
}

#[test]
fn on_a_plane_the_centre_is_a_nose_radius_off_it() {
    let touch = touch_on(Plane { slope: 1.0 }, 5.0, 0.5, true);
    for theta in [0.0, 1.0, FRAC_PI_2, PI, 4.0] {
        let slope = Scalar::cos(theta);
        let x = positions(5.0);
        for (found, x) in touches(&touch, theta, &x).iter().zip(&x) {
            let exact = slope * x + 0.5 * (1.0 + slope * slope).sqrt();
            assert!((found.z - exact).abs() < 1e-14);
        }
    }
}

#[test]
fn in_a_trough_the_sections_across_and_along_are_a_circle_and_a_line() {
    let touch = touch_on(Trough { radius: 4.0 }, 2.5, 1.0, true);
    let x = positions(2.5);
    for (found, x) in touches(&touch, 0.0, &x).iter().zip(&x) {
        assert!((found.z - (4.0 - (9.0 - x * x).sqrt())).abs() < 1e-14);
    }
    for found in touches(&touch, FRAC_PI_2, &x) {
        assert!((found.z - 1.0).abs() < 1e-14);
    }
}

#[test]
fn where_the_edge_ends_before_the_normal_its_end_touches() {
    let tool = Tool {
        nose_radius: 1.0,
        included_angle: Some(60.0 * DEG),
        clearance_angle: None,
        misfit: turnpath_core::Misfit::Refuse,
    };
    let (sin, cos) = Scalar::sin_cos(30.0 * DEG);
    // A plane has a slope of 1 at the edge's end. The waves need a scan.
    let touch = touch_of(Plane { slope: 1.0 }, 2.0, tool, true);
    assert!(touch.has_single_maximum());
    let found = touches(&touch, 0.0, &[0.3])[0];
    // The search stops within 1e-8 R of the end, where the height has a slope of less than 1.
    assert!((found.z - (0.3 + sin + cos)).abs() < 2e-8);
    let waves = Waves {
        height: 2.0,
        wave_number: 0.8,
    };
    let touch = touch_of(waves, 2.0, tool, true);
    assert!(!touch.has_single_maximum());
    let found = touches(&touch, 0.0, &[-0.5])[0];
    let exact = 2.0 * Scalar::sin(0.8 * (sin - 0.5)) + cos;
    assert!((found.z - exact).abs() < 2e-8);
}

#[test]
fn the_path_of_the_contact_lies_on_the_surface_itself() {
    let touch = touch_on(Ball { radius: 10.0 }, 8.0, 1.0, false);
    let found = touches(&touch, 0.3, &[6.0])[0];
    assert!((found.z - 2.0).abs() < 1e-14);
    assert_eq!(found.foot, 6.0);
}

/// The largest height over 400,000 points of the edge.
fn by_brute_force(surface: &impl Surface, nose: f64, theta: f64, x: f64) -> f64 {
    let (sin_theta, cos_theta) = Scalar::sin_cos(theta);
    (0..=400_000)
        .map(|i| {
            let (sin, cos) = Scalar::sin_cos(PI * (f64::from(i) / 400_000.0 - 0.5));
            let s = x + nose * sin;
            surface.sag(s * cos_theta, s * sin_theta) + nose * cos
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn in_a_narrow_groove_the_higher_flank_stops_the_nose() {
    let groove = || Groove {
        slope: 0.5,
        width: 0.1,
    };
    let touch = touch_on(groove(), 1.0, 1.0, true);
    assert!(!touch.has_single_maximum());
    let x = [-0.6, -0.02, -1e-6, 0.0, 1e-7, 1e-3, 0.3];
    for (found, x) in touches(&touch, 0.2, &x).iter().zip(x) {
        let exact = by_brute_force(&groove(), 1.0, 0.2, x);
        assert!((found.z - exact).abs() < 1e-10, "X = {x}: {found:?}");
        assert!(found.foot * x >= 0.0, "X = {x}: the flank of {found:?}");
    }
}

#[test]
fn over_waves_too_narrow_for_it_the_nose_rides_on_crests() {
    let waves = || Waves {
        height: 0.003,
        wave_number: 50.0,
    };
    let touch = touch_on(waves(), 1.0, 1.0, true);
    assert!(!touch.has_single_maximum());
    let x = positions(0.17);
    for (found, x) in touches(&touch, 0.0, &x).iter().zip(&x) {
        let exact = by_brute_force(&waves(), 1.0, 0.0, *x);
        assert!((found.z - exact).abs() < 1e-10, "X = {x}: {found:?}");
    }
}

#[test]
fn far_beyond_the_part_a_single_maximum_is_not_taken_for_granted() {
    // Flat at the part, and steep waves 3 mm away from it.
    struct Shore;
    impl Surface for Shore {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            let far = (x - 3.0) * 4.0;
            (x * 50.0).sin() * 0.003 / ((-far * 4.0).exp() + 1.0)
        }
    }
    let touch = touch_on(Shore, 0.1, 0.5, true);
    assert!(touch.has_single_maximum());
    let x: Vec<f64> = positions(0.1).iter().map(|x| x + 4.2).collect();
    for (found, x) in touches(&touch, 0.0, &x).iter().zip(&x) {
        let exact = by_brute_force(&Shore, 0.5, 0.0, *x);
        assert!((found.z - exact).abs() < 1e-10, "X = {x}: {found:?}");
    }
}

/// Searches go side by side, and those that end first leave. On the axis of a ball the first step ends
/// a search; beyond the small ball there is no height.
#[test]
fn a_touch_in_a_batch_has_the_bits_of_the_touch_alone() {
    let all = [
        (touch_on(Ball { radius: 10.0 }, 8.0, 1.0, true), 8.0),
        (touch_on(Ball { radius: 2.0 }, 1.9, 0.5, true), 2.4),
        (touch_on(Ball { radius: -5.0 }, 4.9, 1.0, true), 4.9),
        (touch_on(Plane { slope: 1.0 }, 5.0, 0.5, false), 5.0),
    ];
    for (touch, rim) in all {
        let theta: Vec<f64> = (0..300).map(|i| 0.37 * f64::from(i)).collect();
        let at = |i: usize| match i % 3 {
            0 => rim * (i as f64 / 150.0 - 1.0),
            _ => 0.0,
        };
        let x: Vec<f64> = (0..300).map(at).collect();
        let (mut batch, mut alone) = (Vec::new(), Vec::new());
        touch.find(&theta, &x, &mut batch).unwrap();
        for (i, found) in batch.iter().enumerate() {
            touch.find(&theta[i..=i], &x[i..=i], &mut alone).unwrap();
            let bits = |touch: &Touch| [touch.z, touch.foot, touch.slope].map(f64::to_bits);
            assert_eq!(bits(found), bits(&alone[0]), "X = {}", x[i]);
        }
    }
}
