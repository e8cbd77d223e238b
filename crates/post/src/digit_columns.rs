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
pub(crate) const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
/// Points with larger numbers, in last digits or in steps, are not found here.
const LARGEST: f64 = 0.25 / f64::EPSILON;

/// Numbers of last digits, or of steps, one for each point.
type Column = [i64; MOST_POINTS];

/// The digits of control points that lie on the controller's steps of time: those of [`Digits::at`].
#[derive(Debug)]
pub(crate) struct DigitColumns {
    steps: Column,
    /// Of C, X and Z.
    position: [Column; 3],
    velocity: [Column; 3],
}

/// How a program says the positions or the velocities of an axis.
#[derive(Clone, Copy)]
struct Scale {
    /// What is taken off a value, mm.
    above: f64,
    /// The unit of the program in that of the path. It is negative where the program's axis runs against the path's.
    unit: f64,
    /// The seconds that a velocity refers to; 1 for a position.
    per: f64,
    /// One in last digits.
    one: f64,
}

impl Scale {
    /// The scales of the positions of C, X and Z.
    fn of_positions(format: &ProgramFormat) -> [Self; 3] {
        let scale = |above: f64, unit: f64| Self {
            above,
            unit,
            per: 1.0,
            one: one(format.position_decimals) as f64,
        };
        let c = scale(0.0, format.c_sign() * DEG);
        [c, scale(0.0, 1.0), scale(format.z_above, 1.0)]
    }

    /// The scales of their velocities.
    fn of_velocities(format: &ProgramFormat) -> [Self; 3] {
        Self::of_positions(format).map(|position| Self {
            above: 0.0,
            per: format.velocity_time(),
            one: one(format.velocity_decimals) as f64,
            ..position
        })
    }

    /// A value of the path as the program would say it with all digits.
    #[inline(always)]
    fn said(&self, value: f64) -> f64 {
        (value - self.above) / self.unit * self.per
    }
}

/// The columns of the positions of C, X and Z, and of their velocities.
fn columns_of(points: &PathBlock) -> [[&[f64]; 3]; 2] {
    [
        [&points.c, &points.x, &points.z],
        [&points.vc, &points.vx, &points.vz],
    ]
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
        let mut fits = in_widest(Steps {
            times: points.t.get(range.clone())?,
            steps_per_s: format.steps_per_s as f64,
            steps: &mut self.steps,
        });
        if !fits {
            return None;
        }
        let [positions, velocities] = columns_of(points);
        let quantities = [
            (positions, Scale::of_positions(format), &mut self.position),
            (velocities, Scale::of_velocities(format), &mut self.velocity),
        ];
        for (values, scales, found) in quantities {
            for ((values, scale), units) in values.into_iter().zip(scales).zip(found) {
                fits &= in_widest(Units {
                    values: values.get(range.clone())?,
                    scale,
                    units,
                });
            }
        }
        fits.then_some(self)
    }

    /// The steps of time of the points.
    pub(crate) fn steps(&self) -> &[i64] {
        &self.steps
    }

    /// Their C, X and Z in last digits.
    pub(crate) fn positions(&self) -> [&[i64]; 3] {
        self.position.each_ref().map(|column| column.as_slice())
    }

    /// The velocities of C, X and Z in last digits.
    pub(crate) fn velocities(&self) -> [&[i64]; 3] {
        self.velocity.each_ref().map(|column| column.as_slice())
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
    scale: Scale,
    units: &'a mut Column,
}

impl Loop for Units<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut fits = true;
        for (units, value) in self.units.iter_mut().zip(self.values) {
            let (whole, number) = nearest(self.scale.said(*value) * self.scale.one);
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

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;
    use turnpath_core::{ParamValue, Params};

    use super::*;
    use crate::digits::{Place, steps_of};
    use crate::posts::post_named;

    /// Points on steps of time, with numbers at and beside halves of a last digit.
    fn points(steps_per_s: i64) -> PathBlock {
        let mut points = PathBlock::default();
        for k in 0..1000_i64 {
            let half = (k - 500) as f64 + [0.0, 0.5, 0.3, -0.5][k as usize % 4];
            let near = [half, half.next_up(), half.next_down()][k as usize % 3] * 1e-7;
            points.push(ControlPoint {
                t: (k * k * 977) as f64 / steps_per_s as f64,
                c: (near + 0.33 * k as f64) * DEG,
                x: near,
                z: -near - 1.0,
                vc: near * DEG,
                vx: 1e3 * near,
                vz: -near,
            });
        }
        points
    }

    #[test]
    fn columns_have_the_digits_of_each_point_alone() {
        for (name, per) in [
            ("pmac-pvt", None),
            ("power-pmac-pvt", None),
            ("pmac-pvt", Some("min")),
        ] {
            let post = post_named(name).unwrap();
            let mut params = Params::new();
            if let Some(per) = per {
                params.set("velocity_per", ParamValue::Text(per.to_owned()));
                params.set("c_sign", ParamValue::Number(-1.0));
            }
            let format = post.format(&params, 1.04, 1e-4);
            let points = points(format.steps_per_s);
            let mut columns = DigitColumns::new(&format, &points).unwrap();
            for first in (0..points.len()).step_by(MOST_POINTS) {
                let range = first..points.len().min(first + MOST_POINTS);
                let found = columns.find(&format, &points, range.clone()).unwrap();
                for number in range {
                    let arrival = points.get(number).unwrap();
                    let place = Place {
                        arrival,
                        segment: None,
                        in_lead: false,
                        grid: [0; 3],
                    };
                    let alone = Digits::at(&format, &place, steps_of(&format, &arrival));
                    assert_eq!(found.at(number - first), alone.ok(), "{name} {number}");
                }
            }
        }
    }

    #[test]
    fn points_between_steps_and_very_large_numbers_are_left_to_others() {
        let post = post_named("pmac-pvt").unwrap();
        let format = post.format(&Params::new(), 0.0, 1e-4);
        let mut good = points(format.steps_per_s);
        good.truncate(10);
        let mut columns = DigitColumns::new(&format, &good).unwrap();
        assert!(columns.find(&format, &good, 0..10).is_some());
        let changes: [fn(&mut PathBlock); 4] = [
            |points| points.t[7] = points.t[7].next_up(),
            |points| points.x[7] = 1.2e8,
            |points| points.vz[7] = f64::INFINITY,
            |points| points.c[7] = f64::NAN,
        ];
        for change in changes {
            let mut points = good.clone();
            change(&mut points);
            assert!(columns.find(&format, &points, 0..10).is_none());
        }
    }
}
