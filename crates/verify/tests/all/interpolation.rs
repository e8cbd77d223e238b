//! The interpolation error against the remainder of cubic interpolation and known figures.

use std::f64::consts::TAU;

use crate::common::{AST5, SPEED, astigmatic_path, figures, touch_on};
use turnpath_core::{DEG, NM};

const STEP: f64 = 9.0 * DEG;
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

#[test]
fn where_z_is_nan_the_error_is_infinite() {
    let mut turn = astigmatic_path(AST5, 0.0, 360, DEG, |_| (RIM, 0.0));
    turn.z[100] = f64::NAN;
    let found = figures(&touch_on(AST5, RIM, 1.0, false), &turn).playback;
    assert_eq!(found.max(), f64::INFINITY);
    assert!((found.at_c - 99.5 * DEG).abs() < DEG);
}
