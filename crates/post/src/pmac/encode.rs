//! Control points into program lines.

use std::io::Write;

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, PathBlock, SectionBlock, Segment};

use super::decimal::{push, push_ms};
use super::error::PmacError;
use super::format::{ENTRY_MS, LONGEST, PmacFormat, QUANTA_PER_MS, QUANTA_PER_S, TURN_DEG, mark};

/// Beyond this a double times a power of ten is not exact.
const LARGEST_UNITS: f64 = 9e15;
/// The program's axes, in the order in which they are written.
const AXES: [char; 3] = ['C', 'X', 'Z'];

/// A control point in the program's digits.
#[derive(Debug, Clone, Copy)]
struct Digits {
    /// Time in quanta.
    quanta: i64,
    /// C, X, Z in last digits; C unwrapped.
    position: [i64; 3],
    /// Their velocities.
    velocity: [i64; 3],
}

/// The lines of a stretch.
pub(super) fn lines(format: &PmacFormat, stretch: &SectionBlock<'_>) -> Result<Vec<u8>, PmacError> {
    let mut text = Vec::new();
    let mut trail = Trail::behind(format, stretch.before)?;
    if stretch.opens_section {
        // Writing to memory cannot fail.
        let _ = writeln!(text, "; {}", mark(stretch.section));
    }
    for point in stretch.points.points() {
        let digits = Digits::of(format, &point, trail.point.as_ref())?;
        match trail.digits {
            None => push_entry(&mut text, format, &digits),
            Some(last) => {
                let quanta = segment_time(&last, &digits, &point)?;
                push_time(&mut text, trail.quanta, quanta);
                trail.quanta = quanta;
                push_move(&mut text, format, &last, &digits, &point)?;
            }
        }
        trail.point = Some(point);
        trail.digits = Some(digits);
    }
    Ok(text)
}

/// The points of a stretch as a program carries them: on the controller's times, in the program's
/// digits, C unwrapped.
pub(super) fn carried(
    format: &PmacFormat,
    stretch: &SectionBlock<'_>,
) -> Result<PathBlock, PmacError> {
    let mut before = stretch.before.last().copied();
    let mut carried = PathBlock {
        shape: stretch.points.shape,
        ..PathBlock::default()
    };
    for point in stretch.points.points() {
        carried.push(Digits::of(format, &point, before.as_ref())?.point(format));
        before = Some(point);
    }
    Ok(carried)
}

/// Whole turns of C that a program leaves out because it begins within 0 to 360 deg, rad.
pub(super) fn turns_left_out(format: &PmacFormat, first: &ControlPoint) -> Result<f64, PmacError> {
    let digits = Digits::of(format, first, None)?;
    let left_out = match format.c_wrapped {
        true => digits.position[0].div_euclid(turn(format)),
        false => 0,
    };
    Ok(format.c_sign() * std::f64::consts::TAU * left_out as f64)
}

/// What the last line left.
struct Trail {
    point: Option<ControlPoint>,
    digits: Option<Digits>,
    /// The time that stands, in quanta.
    quanta: i64,
}

impl Trail {
    fn behind(format: &PmacFormat, before: &[ControlPoint]) -> Result<Self, PmacError> {
        let mut trail = Self {
            point: None,
            digits: None,
            quanta: i64::from(ENTRY_MS * QUANTA_PER_MS),
        };
        for point in before {
            let digits = Digits::of(format, point, trail.point.as_ref())?;
            if let Some(last) = trail.digits {
                trail.quanta = digits.quanta - last.quanta;
            }
            trail.point = Some(*point);
            trail.digits = Some(digits);
        }
        Ok(trail)
    }
}

impl Digits {
    fn of(
        format: &PmacFormat,
        point: &ControlPoint,
        before: Option<&ControlPoint>,
    ) -> Result<Self, PmacError> {
        let quanta = (point.t * QUANTA_PER_S).round();
        let moved = at_time(point, before, quanta / QUANTA_PER_S);
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let positions = [sign * moved.c / DEG, moved.x, moved.z - format.z_above];
        let velocities = [sign * moved.vc / DEG, moved.vx, moved.vz].map(|v| v * per);
        let (mut position, mut velocity) = ([0; 3], [0; 3]);
        for (k, axis) in AXES.into_iter().enumerate() {
            let units = |value: f64, decimals: u32| {
                let t = point.t;
                units(value, decimals).ok_or(PmacError::Digits {
                    axis,
                    value,
                    decimals,
                    t,
                })
            };
            position[k] = units(positions[k], format.position_decimals)?;
            velocity[k] = units(velocities[k], format.velocity_decimals)?;
        }
        Ok(Self {
            quanta: quanta as i64,
            position,
            velocity,
        })
    }

    /// The control point that has these digits.
    fn point(&self, format: &PmacFormat) -> ControlPoint {
        let one = |decimals: u32| 10u64.pow(decimals) as f64;
        let [c, x, z] = self
            .position
            .map(|p| p as f64 / one(format.position_decimals));
        let velocity = one(format.velocity_decimals) * format.velocity_time();
        let [vc, vx, vz] = self.velocity.map(|v| v as f64 / velocity);
        let to_angle = format.c_sign() * DEG;
        ControlPoint {
            t: self.quanta as f64 / QUANTA_PER_S,
            c: to_angle * c,
            x,
            z: z + format.z_above,
            vc: to_angle * vc,
            vx,
            vz,
        }
    }
}

/// A value in last digits, if it fits.
fn units(value: f64, decimals: u32) -> Option<i64> {
    let scaled = (value * 10u64.pow(decimals) as f64).round();
    (scaled.abs() <= LARGEST_UNITS).then_some(scaled as i64)
}

/// The point moved along the cubic that ends at it, by half a quantum at the most.
fn at_time(point: &ControlPoint, before: Option<&ControlPoint>, time: f64) -> ControlPoint {
    let by = time - point.t;
    let bends = before.map_or([(0.0, 0.0); 3], |before| {
        let segment = Segment::between(before, point);
        let h = segment.duration;
        [&segment.c, &segment.x, &segment.z]
            .map(|axis| (axis.bend(1.0) / (h * h), axis.jerk() / (h * h * h)))
    });
    let place = |p: f64, v: f64, (a, j): (f64, f64)| p + by * (v + by * (a / 2.0 + by * j / 6.0));
    let speed = |v: f64, (a, j): (f64, f64)| v + by * (a + by * j / 2.0);
    let [c, x, z] = bends;
    ControlPoint {
        t: time,
        c: place(point.c, point.vc, c),
        x: place(point.x, point.vx, x),
        z: place(point.z, point.vz, z),
        vc: speed(point.vc, c),
        vx: speed(point.vx, x),
        vz: speed(point.vz, z),
    }
}

fn segment_time(last: &Digits, digits: &Digits, point: &ControlPoint) -> Result<i64, PmacError> {
    let quanta = digits.quanta - last.quanta;
    let (t, c_deg) = (point.t, point.c / DEG);
    match quanta {
        1..=LONGEST => Ok(quanta),
        ..1 => Err(PmacError::Short { t, c_deg }),
        _ => {
            let ms = quanta as f64 / f64::from(QUANTA_PER_MS);
            Err(PmacError::Long { ms, t, c_deg })
        }
    }
}

/// The first point: a place, also where distances follow.
fn push_entry(text: &mut Vec<u8>, format: &PmacFormat, digits: &Digits) {
    // Writing to memory cannot fail.
    let _ = writeln!(text, "ABS\nPVT{ENTRY_MS}");
    push_axes(text, format, places(format, digits), digits.velocity);
    if format.incremental {
        text.extend_from_slice(b"INC\n");
    }
}

fn push_time(text: &mut Vec<u8>, stands: i64, quanta: i64) {
    if quanta == stands {
        return;
    }
    text.extend_from_slice(b"PVT");
    push_ms(text, quanta);
    text.push(b'\n');
}

fn push_move(
    text: &mut Vec<u8>,
    format: &PmacFormat,
    last: &Digits,
    digits: &Digits,
    point: &ControlPoint,
) -> Result<(), PmacError> {
    let [c, x, z] = digits.position;
    let [last_c, last_x, last_z] = last.position;
    let positions = if format.incremental {
        [c - last_c, x - last_x, z - last_z]
    } else {
        let half_turn = turn(format) / 2;
        if format.c_wrapped && (c - last_c).abs() >= half_turn {
            let (t, c_deg) = (point.t, point.c / DEG);
            return Err(PmacError::HalfTurn { t, c_deg });
        }
        places(format, digits)
    };
    push_axes(text, format, positions, digits.velocity);
    Ok(())
}

/// A revolution in last digits.
fn turn(format: &PmacFormat) -> i64 {
    TURN_DEG * 10i64.pow(format.position_decimals)
}

fn places(format: &PmacFormat, digits: &Digits) -> [i64; 3] {
    let [c, x, z] = digits.position;
    match format.c_wrapped {
        true => [c.rem_euclid(turn(format)), x, z],
        false => [c, x, z],
    }
}

fn push_axes(text: &mut Vec<u8>, format: &PmacFormat, positions: [i64; 3], velocities: [i64; 3]) {
    for (k, axis) in AXES.into_iter().enumerate() {
        if k > 0 {
            text.push(b' ');
        }
        text.push(axis as u8);
        push(text, positions[k], format.position_decimals);
        text.push(b':');
        push(text, velocities[k], format.velocity_decimals);
    }
    text.push(b'\n');
}
