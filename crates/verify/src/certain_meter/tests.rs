//! Paths that are rounded, against the paths themselves.

use turnpath_core::toolpath::ControlPoint;
use turnpath_core::{Axis, Derivative, Scalar};

use super::*;
use crate::axes::{AxesMotion, Peak};
use crate::comparison::HalfDigits;

/// Half a last digit of each kind of number, all of them different.
const DIGITS: HalfDigits = HalfDigits {
    time: 0.0,
    position: 0.5e-7,
    angle: 0.25e-7,
    velocity: 2e-7,
    angular_velocity: 3e-7,
};

fn rounding() -> Rounding {
    Rounding {
        digits: DIGITS,
        last_digit: Some(2.0 * DIGITS.position),
        ..Rounding::default()
    }
}

/// A wave of Z and a slow X, with points about a millisecond apart, after a change.
fn path(shape: SegmentShape, change: impl Fn(ControlPoint) -> ControlPoint) -> PathBlock {
    let mut t = 0.0;
    let points = (0..300).map(|i| {
        t += 1e-3 * (1.0 + 0.3 * Scalar::sin(f64::from(i)));
        let (sine, cosine) = Scalar::sin_cos(40.0 * t);
        change(ControlPoint {
            t,
            c: 9.0 * t,
            x: 20.0 - 0.2 * t - 1e-4 * sine,
            z: 0.5 * sine,
            vc: 9.0,
            vx: -0.2 - 4e-3 * cosine,
            vz: 20.0 * cosine,
        })
    });
    PathBlock::of(shape, points)
}

fn exact(shape: SegmentShape) -> PathBlock {
    path(shape, |point| point)
}

/// The path with numbers of [`DIGITS`].
fn rounded(shape: SegmentShape) -> PathBlock {
    let kept = |value: f64, half: f64| (value / (2.0 * half)).round() * (2.0 * half);
    path(shape, |point| ControlPoint {
        c: kept(point.c, DIGITS.angle),
        x: kept(point.x, DIGITS.position),
        z: kept(point.z, DIGITS.position),
        vc: kept(point.vc, DIGITS.angular_velocity),
        vx: kept(point.vx, DIGITS.velocity),
        vz: kept(point.vz, DIGITS.velocity),
        ..point
    })
}

fn certain(points: &PathBlock, rounding: Rounding) -> CertainMotion {
    let mut meter = CertainMeter::new(rounding, Rounding::default());
    meter.append(&meter.measure(Section::Cutting, points));
    meter.cut
}

fn peaks(points: &PathBlock) -> impl Iterator<Item = (Axis, Derivative, Peak)> + use<> {
    let motion = AxesMotion::of(points);
    Axis::ALL.into_iter().flat_map(move |axis| {
        Derivative::ALL.into_iter().map(move |derivative| {
            let peak = motion.peak(axis, derivative);
            (axis, derivative, peak.unwrap_or_default())
        })
    })
}

/// Nothing above the motion of the path itself is certain of its file.
#[track_caller]
fn assert_below(certain: &CertainMotion, path: &PathBlock) {
    for (axis, derivative, peak) in peaks(path) {
        let found = certain.peak(axis, derivative).amount;
        let most = peak.amount * (1.0 + 1e-9);
        assert!(found <= most, "{axis:?} {derivative:?}: {found} of {most}");
    }
}

/// Nearly all of the speed of Z is certain.
#[track_caller]
fn assert_fast_z(certain: &CertainMotion) {
    let speed = certain.peak(Axis::Z, Derivative::Velocity).amount;
    assert!((speed - 20.0).abs() < 1e-2, "{speed}");
}

#[test]
fn without_rounding_everything_is_certain() {
    for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
        let points = exact(shape);
        let certain = certain(&points, Rounding::default());
        for (axis, derivative, peak) in peaks(&points) {
            let found = certain.peak(axis, derivative);
            if axis == Axis::C {
                // It turns evenly: its acceleration is that of last bits, and its speed is the same everywhere.
                let is_speed = derivative == Derivative::Velocity;
                let wanted = if is_speed { 9.0 } else { 0.0 };
                assert!((found.amount - wanted).abs() < 1e-6, "{found:?}");
                continue;
            }
            let most = peak.amount;
            let is_near = (0.999 * most..=most).contains(&found.amount);
            assert!(is_near, "{axis:?} {derivative:?}: {found:?} {peak:?}");
            // Within its segment, which is some millisecond long.
            assert!(
                (found.at_c - peak.at_c).abs() < 0.02,
                "{axis:?} {derivative:?}"
            );
        }
    }
}

#[test]
fn what_is_certain_of_a_rounded_path_is_not_above_the_path_itself() {
    for (shape, derivative) in [
        (SegmentShape::Cubic, Derivative::Jerk),
        (SegmentShape::Linear, Derivative::Acceleration),
    ] {
        let file = rounded(shape);
        let certain = certain(&file, rounding());
        assert_below(&certain, &exact(shape));
        assert_fast_z(&certain);
        // The file itself is rougher than the path.
        let of_x = |points: &PathBlock| AxesMotion::of(points).peak(Axis::X, derivative);
        let [rough, smooth] = [of_x(&file), of_x(&exact(shape))].map(Option::unwrap);
        assert!(rough.amount > 1.2 * smooth.amount, "{rough:?} {smooth:?}");
    }
}

/// Axes at rest whose numbers were rounded as badly as they can be: nothing is certain, and half of it would be
/// with half the rounding.
#[test]
fn rounding_at_its_worst_is_no_motion() {
    let point = |t: f64, of_positions: f64, of_velocities: f64| ControlPoint {
        t,
        c: of_positions * DIGITS.angle,
        x: of_positions * DIGITS.position,
        z: of_positions * DIGITS.position,
        vc: of_velocities * DIGITS.angular_velocity,
        vx: of_velocities * DIGITS.velocity,
        vz: of_velocities * DIGITS.velocity,
    };
    let half = HalfDigits {
        time: 0.0,
        position: 0.5 * DIGITS.position,
        angle: 0.5 * DIGITS.angle,
        velocity: 0.5 * DIGITS.velocity,
        angular_velocity: 0.5 * DIGITS.angular_velocity,
    };
    let cubic = [point(0.0, -1.0, -1.0), point(1e-3, 1.0, -1.0)];
    let even = [
        point(0.0, 1.0, 0.0),
        point(1e-3, -1.0, 0.0),
        point(3e-3, 1.0, 0.0),
    ];
    for (shape, points, derivative) in [
        (SegmentShape::Cubic, &cubic[..], Derivative::Acceleration),
        (SegmentShape::Cubic, &cubic[..], Derivative::Jerk),
        (SegmentShape::Linear, &even[..], Derivative::Velocity),
        (SegmentShape::Linear, &even[..], Derivative::Acceleration),
    ] {
        let block = PathBlock::of(shape, points.iter().copied());
        for axis in Axis::ALL {
            let peak = AxesMotion::of(&block).peak(axis, derivative).unwrap();
            let [all, of_half] = [DIGITS, half].map(|digits| {
                let rounding = Rounding {
                    digits,
                    ..Rounding::default()
                };
                certain(&block, rounding).peak(axis, derivative).amount / peak.amount
            });
            assert!(all <= 1e-9, "{axis:?} {derivative:?}: {all}");
            assert!(
                (of_half - 0.5).abs() < 1e-9,
                "{axis:?} {derivative:?}: {of_half}"
            );
        }
    }
    // 3p/h + v is a little more than the velocity of any place of a cubic can be.
    let block = PathBlock::of(SegmentShape::Cubic, cubic);
    let velocity = certain(&block, rounding()).peak(Axis::X, Derivative::Velocity);
    assert_eq!(velocity.amount, 0.0);
}

/// A controller of 24 bits cuts a place of 20 mm by up to 1.2 µm. Its Z is 30 mm below that of the path.
#[test]
fn few_bits_round_large_places_more() {
    let held = |value: f64| f64::from(value as f32);
    let file = path(SegmentShape::Cubic, |point| ControlPoint {
        c: held(point.c),
        x: held(point.x),
        z: held(point.z - 30.0) + 30.0,
        ..point
    });
    let of_bits = Rounding {
        part: 1.0 / f64::from(1 << 24),
        z_above: 30.0,
        ..Rounding::default()
    };
    let certain = certain(&file, of_bits);
    let path = exact(SegmentShape::Cubic);
    assert_below(&certain, &path);
    assert_fast_z(&certain);
    let jerk = |points: &PathBlock| AxesMotion::of(points).peak(Axis::Z, Derivative::Jerk);
    let [rough, smooth] = [jerk(&file), jerk(&path)].map(Option::unwrap);
    assert!(rough.amount > 2.0 * smooth.amount, "{rough:?} {smooth:?}");
}

/// A controller that holds C within a turn rounds it no more after a thousand turns.
#[test]
fn a_wrapped_angle_is_rounded_by_its_part_of_a_turn() {
    let far = path(SegmentShape::Cubic, |point| ControlPoint {
        c: point.c + 1e4,
        vc: 9.0 + Scalar::sin(40.0 * point.t),
        ..point
    });
    let of = |largest_angle: f64| {
        let rounding = Rounding {
            part: 1e-6,
            largest_angle,
            ..Rounding::default()
        };
        certain(&far, rounding)
            .peak(Axis::C, Derivative::Acceleration)
            .amount
    };
    let measured = AxesMotion::of(&far).c.acceleration.amount;
    assert_eq!(of(f64::INFINITY), 0.0);
    assert!((of(std::f64::consts::TAU) - measured).abs() < 0.2 * measured);
}

/// A blend at a border counts, and one with a lead belongs to the lead.
#[test]
fn blocks_have_the_blends_of_the_whole_path() {
    let mut points = exact(SegmentShape::Linear);
    // Corners at the borders of the blocks below.
    for (place, moved) in [(100, 1e-3), (200, 2e-3)] {
        points.z[place] += moved;
    }
    let block = |range: std::ops::RangeInclusive<usize>| {
        let some = points.points().skip(*range.start());
        PathBlock::of(points.shape, some.take(range.count()))
    };
    let parts = [block(0..=100), block(100..=200), block(200..=299)];
    let meter = || CertainMeter::new(Rounding::default(), Rounding::default());
    let mut one = meter();
    for part in &parts {
        one.append(&one.measure(Section::Cutting, part));
    }
    let whole = certain(&points, Rounding::default());
    for axis in Axis::ALL {
        let of = |motion: &CertainMotion| motion.peak(axis, Derivative::Acceleration).amount;
        let [parts, whole] = [&one.cut, &whole].map(of);
        assert!(
            (parts - whole).abs() <= 1e-6 * whole,
            "{axis:?}: {parts} {whole}"
        );
    }

    let mut other = meter();
    let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
    for (part, section) in parts.iter().zip(sections) {
        other.append(&other.measure(section, part));
    }
    let of = |motion: &CertainMotion| motion.peak(Axis::Z, Derivative::Acceleration);
    let [of_leads, of_cut] = [&other.leads, &one.cut].map(of);
    assert!((of_leads.amount / of_cut.amount - 1.0).abs() < 1e-6);
    assert!(of(&other.cut).amount < 0.5 * of(&one.cut).amount);
}

#[test]
fn leads_have_a_rounding_of_their_own() {
    let mut meter = CertainMeter::new(Rounding::default(), rounding());
    meter.append(&meter.measure(Section::LeadOut, &rounded(SegmentShape::Cubic)));
    assert_below(meter.leads().unwrap(), &exact(SegmentShape::Cubic));
    assert_eq!(meter.cut().unwrap(), &CertainMotion::default());
}

/// A spindle that turns evenly, with a segment of a third of a microsecond after 17 seconds: the last bits of C and of the
/// time make a jerk of its own.
#[test]
fn last_bits_of_doubles_make_no_jerk() {
    let spindle = 500.0 * std::f64::consts::TAU / 60.0;
    let point = |t: f64| ControlPoint {
        t,
        c: spindle * t,
        vc: spindle,
        ..ControlPoint::default()
    };
    let points = [16.9, 16.919_999_7, 16.92, 16.94].map(point);
    let block = PathBlock::of(SegmentShape::Cubic, points);
    let measured = AxesMotion::of(&block).c.jerk.amount;
    assert!(measured > 1e3, "{measured}");
    let certain = certain(&block, Rounding::default());
    assert_eq!(certain.peak(Axis::C, Derivative::Jerk).amount, 0.0);
    let speed = certain.peak(Axis::C, Derivative::Velocity).amount;
    assert!((speed - spindle).abs() < 1e-6, "{speed}");
}

#[test]
fn a_segment_that_takes_no_time_is_not_excused() {
    let mut points = rounded(SegmentShape::Cubic);
    points.t[7] = points.t[6];
    let jerk = certain(&points, rounding()).peak(Axis::Z, Derivative::Jerk);
    assert_eq!(jerk.amount, f64::INFINITY);
}

/// Who says that a file has fewer digits than it has would be told that all its limits hold.
#[test]
fn a_path_with_more_digits_than_it_was_said_to_have_has_nothing_that_is_certain() {
    let coarse = Rounding {
        digits: HalfDigits {
            position: 100.0 * DIGITS.position,
            ..DIGITS
        },
        last_digit: Some(200.0 * DIGITS.position),
        ..Rounding::default()
    };
    for (said, is_known) in [
        (rounding(), true),
        (coarse, false),
        (Rounding::default(), true),
    ] {
        let mut meter = CertainMeter::new(said, said);
        meter.append(&meter.measure(Section::Cutting, &rounded(SegmentShape::Cubic)));
        assert_eq!(meter.cut().is_some(), is_known, "{said:?}");
        assert_eq!(meter.leads().is_some(), is_known, "{said:?}");
    }
}
