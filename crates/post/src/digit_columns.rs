//! The digits of many control points at once, in vector registers.

use std::ops::Range;

use turnpath_core::DEG;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::{PathBlock, SegmentShape};

use crate::digits::{Digits, one};
use crate::program_format::ProgramFormat;

/// Most points whose digits are found together: their columns stay in the nearest cache.
pub(crate) const MOST_POINTS: usize = 256;
/// The sum of this and a number of at most [`LARGEST`] has the nearest whole number in its lowest bits.
const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
/// Points with larger numbers, in last digits or in steps, are not found here.
const LARGEST: f64 = 0.25 / f64::EPSILON;

/// Numbers of last digits, or of steps, one for each point.
type Column = [i64; MOST_POINTS];

/// The digits of control points that lie on the controller's steps of time: those of [`Digits::at`].
pub(crate) struct DigitColumns {
    steps: Column,
    /// Of C, X and Z.
    position: [Column; 3],
    velocity: [Column; 3],
}

impl DigitColumns {
    /// Columns without a point; `None` where a program of this format does not say each point of the path with its
    /// velocities.
    pub(crate) fn new(format: &ProgramFormat, points: &PathBlock) -> Option<Box<Self>> {
        let has_velocities = points.shape == SegmentShape::Cubic && format.chords.is_none();
        let empty = [0; MOST_POINTS];
        has_velocities.then(|| {
            Box::new(Self {
                steps: empty,
                position: [empty; 3],
                velocity: [empty; 3],
            })
        })
    }

    /// Finds the digits of points of a block, at most [`MOST_POINTS`]. `None` where one of them lies between two
    /// steps of time, or where a number is very large.
    pub(crate) fn find(
        &mut self,
        format: &ProgramFormat,
        points: &PathBlock,
        range: Range<usize>,
    ) -> Option<&Self> {
        let steps = Steps {
            times: points.t.get(range.clone())?,
            steps_per_s: format.steps_per_s as f64,
            steps: &mut self.steps,
        };
        let mut fits = in_widest(steps);
        let axes = [
            (&points.c, &points.vc, 0.0),
            (&points.x, &points.vx, 0.0),
            (&points.z, &points.vz, format.z_above),
        ];
        for (axis, (positions, velocities, above)) in axes.into_iter().enumerate() {
            let position = Units {
                values: positions.get(range.clone())?,
                above,
                factor: 1.0,
                one: one(format.position_decimals) as f64,
                units: self.position.get_mut(axis)?,
            };
            let velocity = Units {
                values: velocities.get(range.clone())?,
                above: 0.0,
                factor: format.velocity_time(),
                one: one(format.velocity_decimals) as f64,
                units: self.velocity.get_mut(axis)?,
            };
            for units in [position, velocity] {
                fits &= match axis {
                    0 => in_widest(Angles(units, format.c_sign())),
                    _ => in_widest(units),
                };
            }
        }
        fits.then_some(self)
    }

    /// The digits of one of the points that were found.
    pub(crate) fn at(&self, index: usize) -> Option<Digits> {
        let of_axes =
            |[c, x, z]: &[Column; 3]| Some([*c.get(index)?, *x.get(index)?, *z.get(index)?]);
        Some(Digits {
            steps: *self.steps.get(index)?,
            position: of_axes(&self.position)?,
            velocity: of_axes(&self.velocity)?,
        })
    }
}

/// The loop over the steps of times; it says whether each time is that of its step.
struct Steps<'a> {
    times: &'a [f64],
    steps_per_s: f64,
    steps: &'a mut Column,
}

impl Loop for Steps<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut fits = true;
        for (steps, time) in self.steps.iter_mut().zip(self.times) {
            let (whole, number) = nearest(time * self.steps_per_s);
            fits &= (whole.abs() <= LARGEST) & (whole / self.steps_per_s == *time);
            *steps = number;
        }
        fits
    }
}

/// The loop over values in last digits; it says whether none of them is very large.
struct Units<'a> {
    values: &'a [f64],
    /// What is taken off each value.
    above: f64,
    /// What it is then multiplied by.
    factor: f64,
    /// One in last digits.
    one: f64,
    units: &'a mut Column,
}

impl Loop for Units<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut fits = true;
        for (units, value) in self.units.iter_mut().zip(self.values) {
            let (whole, number) = nearest((value - self.above) * self.factor * self.one);
            fits &= whole.abs() <= LARGEST;
            *units = number;
        }
        fits
    }
}

/// The same loop over angles in rad, which a program says in deg, with the sign of its C.
struct Angles<'a>(Units<'a>, f64);

impl Loop for Angles<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self(all, sign) = self;
        let mut fits = true;
        for (units, value) in all.units.iter_mut().zip(all.values) {
            let (whole, number) = nearest(sign * value / DEG * all.factor * all.one);
            fits &= whole.abs() <= LARGEST;
            *units = number;
        }
        fits
    }
}

/// The whole number next to a value, as a double and as an integer, and of two the one farther from zero. Beyond
/// [`LARGEST`] the integer is another one.
#[inline(always)]
fn nearest(value: f64) -> (f64, i64) {
    let even = (value + TO_WHOLE) - TO_WHOLE;
    let rest = value - even;
    let up = (rest >= 0.5) & (value > 0.0);
    let down = (rest <= -0.5) & (value < 0.0);
    let whole = even + if up { 1.0 } else { 0.0 } - if down { 1.0 } else { 0.0 };
    let number = (whole + TO_WHOLE)
        .to_bits()
        .wrapping_sub(TO_WHOLE.to_bits());
    (whole, number as i64)
}
