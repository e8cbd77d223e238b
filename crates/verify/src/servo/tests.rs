use std::f64::consts::TAU;

use super::*;
use turnpath_core::toolpath::{ControlPoint, SegmentShape};

/// 70 Hz.
const BANDWIDTH: f64 = TAU * 70.0;

fn axis(damping: f64) -> AxisServo {
    AxisServo {
        frequency: BANDWIDTH,
        damping,
        delay: 0.0,
        velocity_forward: 0.0,
        acceleration_forward: 0.0,
    }
}

fn segments(points: impl Iterator<Item = ControlPoint>, shape: SegmentShape) -> Vec<Segment> {
    let mut block = PathBlock {
        shape,
        ..PathBlock::default()
    };
    points.for_each(|point| block.push(point));
    block.segments().collect()
}

/// z = sin(ωt) in steps at which a cubic is accurate to 1e-9.
fn sine(frequency: f64, periods: f64) -> Vec<Segment> {
    let steps = (periods * 400.0) as u32;
    let point = |k: u32| {
        let t = TAU / frequency * f64::from(k) / 400.0;
        let (z, vz) = Scalar::sin_cos(frequency * t);
        ControlPoint {
            t,
            z,
            vz: frequency * vz,
            ..ControlPoint::default()
        }
    };
    segments((0..=steps).map(point), SegmentShape::Cubic)
}

/// z = v t, in motion from the start.
fn ramp(v: f64, shape: SegmentShape) -> Vec<Segment> {
    let point = |k: i32| ControlPoint {
        t: 0.01 * f64::from(k),
        z: v * 0.01 * f64::from(k),
        vz: v,
        ..ControlPoint::default()
    };
    segments((0..=50).map(point), shape)
}

/// The position y of the axis at the middle of each segment, with its time.
fn response(servo: AxisServo, segments: &[Segment]) -> Vec<(f64, f64)> {
    let mut follower = Follower::new(servo);
    let mut positions = Vec::new();
    for segment in segments {
        follower.push(CommandPiece::new(segment, &segment.z));
        let time = segment.start + 0.5 * segment.duration;
        positions.push((time, follower.at(time)));
    }
    positions
}

/// H(iω) = (ω₀² + 2ζω₀k_v iω − k_a ω²)/(ω₀² + 2ζω₀ iω − ω²), amplitude and phase, with the delay.
fn transfer(servo: AxisServo, omega: f64) -> (f64, f64) {
    let w = servo.frequency;
    let top = (
        w * w - servo.acceleration_forward * omega * omega,
        2.0 * servo.damping * w * servo.velocity_forward * omega,
    );
    let bottom = (w * w - omega * omega, 2.0 * servo.damping * w * omega);
    let amplitude = Scalar::hypot(top.0, top.1) / Scalar::hypot(bottom.0, bottom.1);
    let phase = Scalar::atan2(top.1, top.0) - Scalar::atan2(bottom.1, bottom.0);
    (amplitude, phase - omega * servo.delay)
}

#[test]
fn a_sine_has_amplitude_and_phase_of_the_transfer_function() {
    let forward = AxisServo {
        velocity_forward: 0.8,
        acceleration_forward: 0.3,
        ..axis(0.7)
    };
    let delayed = AxisServo {
        delay: 1.3e-3,
        ..forward
    };
    for servo in [axis(0.3), axis(0.7), axis(1.0), axis(1.8), forward, delayed] {
        for ratio in [0.1, 0.7, 1.0, 3.0] {
            let omega = ratio * BANDWIDTH;
            let (amplitude, phase) = transfer(servo, omega);
            let periods = 3.0 + 12.0 * ratio / servo.damping.min(servo.damping.recip());
            for (time, y) in response(servo, &sine(omega, periods))
                .into_iter()
                .rev()
                .take(400)
            {
                let expected = amplitude * Scalar::sin(omega * time + phase);
                assert!(
                    (y - expected).abs() < 1e-8,
                    "{servo:?}, {ratio}: {y}, {expected}"
                );
            }
        }
    }
}

#[test]
fn a_ramp_is_followed_late_by_2_zeta_over_omega_unless_its_velocity_is_fed_forward() {
    for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
        for forward in [0.0, 0.25, 1.0] {
            let servo = AxisServo {
                velocity_forward: forward,
                ..axis(0.7)
            };
            let expected = -30.0 * 2.0 * 0.7 / BANDWIDTH * (1.0 - forward);
            for (time, y) in response(servo, &ramp(30.0, shape)) {
                let error = y - 30.0 * time;
                assert!((error - expected).abs() < 1e-12, "{error}, {expected}");
            }
        }
    }
}

#[test]
fn a_ramp_from_rest_rises_as_the_closed_form_says() {
    // Straight segments: at rest until t = 0.01, then at the rate v.
    // e = −L v (1 − e^{−st}(cos dt + (s − 1/L)/d sin dt)).
    let point = |t: f64, z: f64| ControlPoint {
        t,
        z,
        ..ControlPoint::default()
    };
    let points = [point(0.0, 0.0), point(0.01, 0.0), point(0.03, 0.6)];
    let segments = segments(points.into_iter(), SegmentShape::Linear);
    let servo = axis(0.7);
    let mut follower = Follower::new(servo);
    for segment in &segments {
        follower.push(CommandPiece::new(segment, &segment.z));
    }
    let (v, late, s) = (30.0, AxisResponse(servo).lateness(), 0.7 * BANDWIDTH);
    let d = BANDWIDTH * (1.0f64 - 0.49).sqrt();
    for k in 0..=20 {
        let t = 0.001 * f64::from(k);
        let (sin, cos) = Scalar::sin_cos(d * t);
        let fading = Scalar::exp(-s * t) * (cos + (s - late.recip()) / d * sin);
        let expected = v * t - late * v * (1.0 - fading);
        let y = follower.at(0.01 + t);
        assert!((y - expected).abs() < 1e-12, "{t}: {y}, {expected}");
    }
}

#[test]
fn a_wide_band_or_whole_feed_forward_leaves_nothing() {
    let wide = AxisServo {
        frequency: 1e9,
        ..axis(0.7)
    };
    let whole = AxisServo {
        velocity_forward: 1.0,
        acceleration_forward: 1.0,
        ..axis(0.7)
    };
    for servo in [wide, whole] {
        for (time, y) in response(servo, &sine(50.0, 3.0)) {
            assert!((y - Scalar::sin(50.0 * time)).abs() < 1e-7);
        }
    }
}

mod on_a_surface {
    use super::*;
    use std::sync::Arc;
    use turnpath_core::{Misfit, ParamValue, Params, Part, Strategy, Tool};
    use turnpath_surfaces::Astigmatic;

    use crate::subject::Subject;

    const K: f64 = 0.08;
    const SPINDLE: f64 = TAU * 8.0;

    /// The path is that of the contact: the true position lies on the saddle itself.
    fn touch() -> FirstTouch {
        let mut params = Params::new();
        params.set("k", ParamValue::Number(K));
        let subject = Subject {
            surface: Arc::new(Astigmatic::new(&params).expect("a surface")),
            part: Part {
                aperture_radius: 2.5,
                inner_radius: 0.0,
            },
            tool: Tool {
                nose_radius: 1.0,
                included_angle: None,
                clearance_angle: None,
                misfit: Misfit::Refuse,
            },
            compensates_nose: false,
        };
        FirstTouch::new(subject).expect("a first touch")
    }

    /// Circles at X = 2, z = kX² sin 2C.
    fn circles() -> PathBlock {
        let mut points = PathBlock::default();
        for k in 0..=2000 {
            let c = TAU * f64::from(k) / 400.0;
            let (sin, cos) = Scalar::sin_cos(2.0 * c);
            points.push(ControlPoint {
                t: c / SPINDLE,
                c,
                x: 2.0,
                z: K * 4.0 * sin,
                vc: SPINDLE,
                vx: 0.0,
                vz: K * 4.0 * 2.0 * SPINDLE * cos,
            });
        }
        points
    }

    fn cut(servo: &Servo, blocks: &[PathBlock]) -> ServoFigures {
        let (touch, mut meter) = (touch(), ServoMeter::new(servo));
        for block in blocks {
            let start = meter.advance(block);
            let figures = ServoMeter::measure(&touch, &start, block).expect("figures");
            meter.append(&figures);
        }
        *meter.figures()
    }

    fn blocks(points: &PathBlock, most: usize) -> Vec<PathBlock> {
        let mut blocks = Vec::new();
        for from in (0..points.len() - 1).step_by(most) {
            let mut block = PathBlock::default();
            let to = (from + most).min(points.len() - 1);
            (from..=to)
                .filter_map(|i| points.get(i))
                .for_each(|point| block.push(point));
            blocks.push(block);
        }
        blocks
    }

    fn same(axis: AxisServo) -> Servo {
        Servo {
            c: axis,
            x: axis,
            z: axis,
        }
    }

    /// Z responds to sin 2C with the transfer function at 2ω; C is late by 2ζ/ω₀.
    #[test]
    fn the_error_of_a_circle_is_that_of_both_phases() {
        let servo = axis(0.7);
        let (points, settled) = (circles(), 1200);
        let mut meter = ServoMeter::new(&same(servo));
        let parts = blocks(&points, settled);
        meter.advance(&parts[0]);
        let start = meter.advance(&parts[1]);
        let figures = ServoMeter::measure(&touch(), &start, &parts[1])
            .expect("figures")
            .0;
        let (amplitude, phase) = transfer(servo, 2.0 * SPINDLE);
        let turned = 2.0 * SPINDLE * AxisResponse(servo).lateness();
        // |H sin(φ + p) − sin(φ − turned)| over all φ.
        let (sin, cos) = Scalar::sin_cos(phase + turned);
        let expected = K * 4.0 * Scalar::hypot(amplitude * cos - 1.0, amplitude * sin);
        assert!(
            (figures.max() / expected - 1.0).abs() < 1e-3,
            "{}",
            figures.max() / expected
        );
        assert!((figures.rms() / (expected / 2f64.sqrt()) - 1.0).abs() < 1e-3);
        assert!((figures.c.max / (SPINDLE * AxisResponse(servo).lateness()) - 1.0).abs() < 1e-9);
        assert!(figures.x.max < 1e-12);
    }

    #[test]
    fn a_delay_of_all_axes_alike_leaves_the_part_as_it_was() {
        let late = AxisServo {
            velocity_forward: 1.0,
            acceleration_forward: 1.0,
            delay: 2e-3,
            ..axis(0.7)
        };
        let points = circles();
        let figures = cut(&same(late), std::slice::from_ref(&points));
        assert!((figures.c.max - SPINDLE * 2e-3).abs() < 1e-9);
        // Before the path the axes are taken to move at a constant rate, so the first moments of
        // the path do not count.
        let mut meter = ServoMeter::new(&same(late));
        let parts = blocks(&points, 400);
        meter.advance(&parts[0]);
        let start = meter.advance(&parts[1]);
        let later = ServoMeter::measure(&touch(), &start, &parts[1])
            .expect("figures")
            .0;
        assert!(later.max() < 1e-7, "{}", later.max());
    }

    #[test]
    fn the_division_into_blocks_does_not_matter() {
        let servo = Servo {
            z: AxisServo {
                delay: 5e-3,
                ..axis(0.6)
            },
            ..same(axis(0.7))
        };
        let points = circles();
        let whole = cut(&servo, std::slice::from_ref(&points));
        for most in [1, 7, 400] {
            let parts = cut(&servo, &blocks(&points, most));
            assert_eq!((parts.max(), parts.at_c), (whole.max(), whole.at_c));
            assert!((parts.rms() / whole.rms() - 1.0).abs() < 1e-12);
            assert_eq!(parts.z.max, whole.z.max);
        }
    }
}
