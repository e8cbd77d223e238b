//! The figures of a path that is measured in blocks, and the motion of its axes.

use std::f64::consts::TAU;

use crate::common::{AST5, SPEED, astigmatic_path, figures, touch_on};
use turnpath_core::DEG;
use turnpath_core::toolpath::PathBlock;
use turnpath_verify::Meter;

/// The points from `from` to `to`, both included.
fn block(path: &PathBlock, from: usize, to: usize) -> PathBlock {
    let mut part = PathBlock::default();
    for point in path.points().skip(from).take(to - from + 1) {
        part.push(point);
    }
    part
}

#[test]
fn blocks_of_any_length_give_the_figures_of_the_whole() {
    let feed = 0.02;
    let law = |theta: f64| (2.5 - feed * theta / TAU, -feed / TAU);
    let path = astigmatic_path(AST5, 1.0, 400, 7.3 * DEG, law);
    let touch = touch_on(AST5, 2.5, 1.0, true);
    let whole = figures(&touch, &path);
    // Half of the contacts lie beyond the rim.
    assert!(whole.residual.cusps > 1000);
    // Blocks within a section, of a part of a turn, of a turn, of more than a turn, of four turns,
    // and of all segments but one.
    let all: [&[usize]; 6] = [
        &[1],
        &[1, 2, 50, 3],
        &[7, 49, 50],
        &[130, 1],
        &[200],
        &[399, 1],
    ];
    for lengths in all {
        let mut meter = Meter::new(touch.clone());
        let (mut from, mut next) = (0, lengths.iter().cycle());
        while from < 400 {
            let to = (from + next.next().copied().unwrap_or(1)).min(400);
            let figures = Meter::measure(&touch, &block(&path, from, to)).unwrap();
            assert_eq!(figures.per_segment.len(), to - from);
            meter.append(figures).unwrap();
            from = to;
        }
        let found = meter.figures().unwrap();
        assert_eq!(found.playback.extreme, whole.playback.extreme);
        assert_eq!(found.playback.at_c, whole.playback.at_c);
        assert!((found.playback.rms() / whole.playback.rms() - 1.0).abs() < 1e-12);
        assert_eq!(found.residual, whole.residual, "{lengths:?}");
        assert_eq!(found.coverage, whole.coverage, "{lengths:?}");
        assert_eq!(found.axes.z.velocity, whole.axes.z.velocity);
        assert_eq!(found.axes.z.acceleration, whole.axes.z.acceleration);
        assert_eq!(found.axes.z.jerk, whole.axes.z.jerk);
        let rms = |axes: &turnpath_verify::AxesMotion| axes.z.rms_acceleration();
        assert!((rms(&found.axes) / rms(&whole.axes) - 1.0).abs() < 1e-12);
    }
}

/// X = rim − f θ/2π at constant speed, Z = k X² sin 2θ.
#[test]
fn axes_move_as_the_closed_form_says() {
    let (rim, feed) = (2.5, 1e-5);
    let law = |theta: f64| (rim - feed * theta / TAU, -feed / TAU);
    let path = astigmatic_path(AST5, 0.0, 720, DEG, law);
    let axes = figures(&touch_on(AST5, rim, 1.0, false), &path).axes;
    let near = |found: f64, exact: f64, part: f64| {
        assert!((found / exact - 1.0).abs() < part, "{found}, not {exact}");
    };
    near(axes.c.velocity.amount, SPEED, 1e-12);
    assert!(axes.c.acceleration.amount < 1e-6 * SPEED * SPEED);
    // X is 2.5 mm and moves in steps of 3e-8 mm, so its rate has no more digits than this.
    near(axes.x.velocity.amount, feed / TAU * SPEED, 1e-7);
    let height = AST5.k * rim * rim;
    near(axes.z.velocity.amount, height * 2.0 * SPEED, 1e-3);
    let squared = SPEED * SPEED;
    near(axes.z.acceleration.amount, height * 4.0 * squared, 1e-3);
    let mean = 0.5f64.sqrt();
    near(
        axes.z.rms_acceleration(),
        height * 4.0 * squared * mean,
        1e-3,
    );
    near(axes.z.jerk.amount, height * 8.0 * squared * SPEED, 1e-3);
}
