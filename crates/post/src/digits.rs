//! A control point in a program's digits, on its steps of time.

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Segment, SegmentShape};

use crate::powers_of_ten::POWERS_OF_TEN;
use crate::program_error::ProgramError;
use crate::program_format::{ProgramFormat, TURN_DEG};

/// Beyond this a double times a power of ten is not exact.
const LARGEST_UNITS: f64 = 9e15;
/// The program's axes, in the order in which they are written.
pub(crate) const AXES: [char; 3] = ['C', 'X', 'Z'];

/// A control point in a program's digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits {
    /// Time in steps.
    pub steps: i64,
    /// C, X, Z in last digits; C unwrapped.
    pub position: [i64; 3],
    /// Their velocities in last digits; zero in a program without velocities.
    pub velocity: [i64; 3],
}

/// A segment in a program's digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DigitSegment {
    /// Where it begins.
    pub from: Digits,
    /// Where it ends.
    pub to: Digits,
    /// The steps of the segment before; `None` for the first segment.
    pub steps_before: Option<i64>,
}

impl DigitSegment {
    /// The steps that it takes.
    pub fn steps(&self) -> i64 {
        self.to.steps - self.from.steps
    }

    /// Time in s and C of the path in deg where it ends.
    pub(crate) fn end(&self, format: &ProgramFormat) -> (f64, f64) {
        let c = self.to.position[0] as f64 / 10u64.pow(format.position_decimals) as f64;
        let t = self.to.steps as f64 / format.steps_per_s as f64;
        (t, format.c_sign() * c)
    }
}

/// The positions that a program's line says: absolute ones with C wrapped where the format has it so,
/// or distances.
pub(crate) fn said_positions(format: &ProgramFormat, segment: &DigitSegment) -> [i64; 3] {
    let ([c, x, z], [from_c, from_x, from_z]) = (segment.to.position, segment.from.position);
    match format.incremental {
        true => [c - from_c, x - from_x, z - from_z],
        false => said_place(format, &segment.to),
    }
}

/// The absolute position of a point as a program says it.
pub(crate) fn said_place(format: &ProgramFormat, digits: &Digits) -> [i64; 3] {
    let [c, x, z] = digits.position;
    match format.c_wrapped {
        true => [c.rem_euclid(turn(format)), x, z],
        false => [c, x, z],
    }
}

/// A place on the path at or near a control point.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    /// The point with the velocities at which it is reached.
    pub(crate) arrival: ControlPoint,
    /// What is played up to the point; `None` at the path's first point.
    pub(crate) segment: Option<&'a Segment>,
    /// Whether it is of a lead.
    pub(crate) in_lead: bool,
    /// A position from which places are multiples of their steps away.
    pub(crate) grid: [i64; 3],
}

/// The time of a point in steps.
pub(crate) fn steps_of(format: &ProgramFormat, point: &ControlPoint) -> i64 {
    let steps = point.t * format.steps_per_s as f64;
    match steps.abs() <= LARGEST_UNITS {
        true => rounded(steps),
        false => steps.round() as i64,
    }
}

impl Digits {
    /// The digits at a step of time at or near a place.
    pub(crate) fn at(
        format: &ProgramFormat,
        place: &Place<'_>,
        steps: i64,
    ) -> Result<Self, ProgramError> {
        let point = &place.arrival;
        let moved = at_time(
            point,
            place.segment,
            steps as f64 / format.steps_per_s as f64,
        );
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let positions = [sign * moved.c / DEG, moved.x, moved.z - format.z_above];
        let velocities = [sign * moved.vc / DEG, moved.vx, moved.vz].map(|v| v * per);
        let has_velocities = format.shape() == SegmentShape::Cubic;
        let multiples = format.position_steps(place.in_lead);
        let (mut position, mut velocity) = ([0; 3], [0; 3]);
        for (k, axis) in AXES.into_iter().enumerate() {
            let units = |value: f64, decimals: u32| {
                let t = point.t;
                units(value, decimals).ok_or(ProgramError::Digits {
                    axis,
                    value,
                    decimals,
                    t,
                })
            };
            let digits = units(positions[k], format.position_decimals)?;
            let origin = place.grid[k];
            position[k] = origin + nearest_multiple(digits - origin, multiples[k]);
            if has_velocities {
                velocity[k] = units(velocities[k], format.velocity_decimals)?;
            }
        }
        Ok(Self {
            steps,
            position,
            velocity,
        })
    }

    /// The control point that has these digits.
    pub(crate) fn point(&self, format: &ProgramFormat) -> ControlPoint {
        let one = |decimals: u32| 10u64.pow(decimals) as f64;
        let position = |p: i64| p as f64 / one(format.position_decimals);
        let held = |p: i64| match format.mantissa_bits {
            Some(bits) if !format.incremental => held(position(p), bits),
            _ => position(p),
        };
        let [c, x, z] = self.position;
        let turns_apart = match format.c_wrapped {
            true => c.div_euclid(turn(format)) * turn(format),
            false => 0,
        };
        let c = position(turns_apart) + held(c - turns_apart);
        let [x, z] = [x, z].map(held);
        let velocity = one(format.velocity_decimals) * format.velocity_time();
        let [vc, vx, vz] = self.velocity.map(|v| v as f64 / velocity);
        let to_angle = format.c_sign() * DEG;
        ControlPoint {
            t: self.steps as f64 / format.steps_per_s as f64,
            c: to_angle * c,
            x,
            z: z + format.z_above,
            vc: to_angle * vc,
            vx,
            vz,
        }
    }
}

/// A number with so many bits of its size, rounded: the other bits of the double's 53 are cut.
fn held(value: f64, bits: u32) -> f64 {
    let cut = f64::MANTISSA_DIGITS.saturating_sub(bits);
    let half = (1_u64 << cut) >> 1;
    f64::from_bits((value.to_bits() + half) >> cut << cut)
}

/// One in last digits.
pub(crate) fn one(decimals: u32) -> u64 {
    match POWERS_OF_TEN.get(decimals as usize) {
        Some(one) => *one,
        None => 10u64.pow(decimals),
    }
}

/// A value in last digits, if it fits.
fn units(value: f64, decimals: u32) -> Option<i64> {
    let scaled = value * one(decimals) as f64;
    (scaled.abs() <= LARGEST_UNITS).then(|| rounded(scaled))
}

/// The whole number next to a value of at most [`LARGEST_UNITS`], and of two the one farther from zero, as
/// [`f64::round`] has it, without a call.
fn rounded(value: f64) -> i64 {
    let whole = value as i64;
    let rest = value - whole as f64;
    whole + i64::from(rest >= 0.5) - i64::from(rest <= -0.5)
}

/// The multiple of `step` next to a value.
fn nearest_multiple(value: i64, step: i64) -> i64 {
    if step == 1 {
        return value;
    }
    (value + step / 2).div_euclid(step) * step
}

/// The point at a time in or near the segment that ends at `point` with the velocities of the point.
fn at_time(point: &ControlPoint, segment: Option<&Segment>, time: f64) -> ControlPoint {
    let by = time - point.t;
    if by == 0.0 {
        return *point;
    }
    let bends = segment.map_or([(0.0, 0.0); 3], |segment| {
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

/// A revolution in last digits.
pub(crate) fn turn(format: &ProgramFormat) -> i64 {
    TURN_DEG * 10i64.pow(format.position_decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_as_the_standard_library_rounds_them() {
        let halves = (-9..9).map(|k| f64::from(k) + 0.5);
        let large = [
            LARGEST_UNITS,
            4_503_599_627_370_496.5,
            4_503_599_627_370_495.5,
            1e15 + 0.5,
        ];
        let values = halves
            .chain(large)
            .chain([0.0, 0.499_999_999_999_999_94, 1e-300]);
        for value in values.flat_map(|value| [value, value.next_up(), value.next_down()]) {
            for value in [value, -value] {
                assert_eq!(rounded(value), value.round() as i64, "{value:?}");
            }
        }
    }
}
