//! How hard the axes work for certain, where the numbers of a file were rounded to their last digits.
//!
//! A jerk is a difference of positions over the third power of a time. On a segment of a millisecond, half a last
//! digit of 10⁻⁷ mm at both ends makes up to 1200 mm/s³, and moves nothing by more than that half digit. On a segment
//! of a microsecond the last bits of doubles do the same. So what rounding can make of an amount, segment by segment,
//! is taken away from it.

use turnpath_core::toolpath::{Cubic, Segment};
use turnpath_core::{Axis, Derivative};

use crate::axes::Peak;
use crate::axis_terms::AxisTerm;
use crate::comparison::HalfDigits;

/// What last bits of doubles may make of a number, as a part of it. Several operations lie between it and the path, and
/// with half of this some of what they make stays. With more, real jerks of short segments late in a path would go.
pub(crate) const OF_DOUBLES: f64 = 8.0 * f64::EPSILON;

/// By how much numbers of a path may lie beside those that were rounded, besides the last bits of doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding {
    /// Of positions and velocities. Straight lines have no velocities, and steps of time are exact.
    pub digits: HalfDigits,
    /// By how much places of Z may have been lifted besides, mm.
    pub lift: f64,
    /// The last digit of X, mm; `None` where X has all digits of a double.
    pub last_digit: Option<f64>,
    /// The part of a position that is rounded besides: that of a controller that holds few bits.
    pub part: f64,
    /// The largest angle that the controller holds, rad; infinite where C is not wrapped.
    pub largest_angle: f64,
    /// Z of the path less Z of the program, mm.
    pub z_above: f64,
}

impl Default for Rounding {
    /// All digits of a double.
    fn default() -> Self {
        Self {
            digits: HalfDigits::default(),
            lift: 0.0,
            last_digit: None,
            part: 0.0,
            largest_angle: f64::INFINITY,
            z_above: 0.0,
        }
    }
}

impl Rounding {
    /// The most that rounding can make of the position of an axis at either end of a segment. An axis at a wrong time is
    /// at a wrong place.
    fn of_positions(&self, axis: Axis, segment: &Segment) -> f64 {
        let [from, to] = [0.0, 1.0].map(|s| played(segment, axis).value(s));
        let held = |position: f64| match axis {
            Axis::C => position.abs().min(self.largest_angle),
            Axis::X => position.abs(),
            Axis::Z => (position - self.z_above).abs(),
        };
        let size = held(from).max(held(to));
        let speed = (to - from).abs() / segment.duration;
        let digits = match axis {
            Axis::C => self.digits.angle,
            Axis::X => self.digits.position,
            Axis::Z => self.digits.position + self.lift,
        };
        let end = segment.start.abs() + segment.duration;
        let of_doubles = OF_DOUBLES * (from.abs().max(to.abs()) + speed * end);
        digits + self.part * size + of_doubles
    }

    /// The most that rounding can make of the velocity, acceleration and jerk of a cubic. With p and v the rounding
    /// of positions and velocities, and h the time: 3p/h + v, 12p/h² + 6v/h and 24p/h³ + 12v/h², by the Hermite
    /// form of a cubic.
    fn of_cubic(&self, axis: Axis, segment: &Segment) -> [f64; 3] {
        let (cubic, duration) = (played(segment, axis), segment.duration);
        let rate = self.of_positions(axis, segment) / duration;
        let digits = match axis {
            Axis::C => self.digits.angular_velocity,
            Axis::X | Axis::Z => self.digits.velocity,
        };
        let largest = cubic.slope(0.0).abs().max(cubic.slope(1.0).abs()) / duration;
        let velocity = digits + OF_DOUBLES * largest;
        let first = 3.0 * rate + velocity;
        let second = (12.0 * rate + 6.0 * velocity) / duration;
        [first, second, 2.0 * second / duration]
    }

    /// The most that rounding can make of the rate of a straight segment.
    fn of_rate(&self, axis: Axis, line: &Segment) -> f64 {
        2.0 * self.of_positions(axis, line) / line.duration
    }
}

/// The largest amounts of velocity, acceleration and jerk of each axis that are certain, in mm or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CertainMotion {
    /// By axis, and by derivative.
    largest: [[Peak; Derivative::ALL.len()]; Axis::ALL.len()],
}

impl CertainMotion {
    /// The largest amount of a derivative, and the middle of its segment, or the corner of its blend.
    pub fn peak(&self, axis: Axis, derivative: Derivative) -> Peak {
        self.largest[axis as usize][derivative as usize]
    }

    /// Rises to what is certain of an amount at a place.
    fn rise(&mut self, (axis, derivative): (Axis, Derivative), found: Peak, rounding: f64) {
        let certain = match rounding.is_finite() {
            true => found.amount - rounding,
            // Of a segment that takes no time everything is certain.
            false => found.amount,
        };
        let largest = &mut self.largest[axis as usize][derivative as usize];
        if certain > largest.amount {
            *largest = Peak {
                amount: certain,
                ..found
            };
        }
    }

    pub(crate) fn include_cubic(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let term = AxisTerm::of(played(segment, axis), segment.duration);
            let amounts = [term.velocity, term.acceleration, term.jerk];
            let largest = &self.largest[axis as usize];
            if amounts
                .iter()
                .zip(largest)
                .all(|(amount, largest)| *amount <= largest.amount)
            {
                // Rounding takes from an amount, and never adds to it.
                continue;
            }
            let roundings = rounding.of_cubic(axis, segment);
            let each = amounts.into_iter().zip(roundings);
            for (derivative, (amount, rounding)) in Derivative::ALL.into_iter().zip(each) {
                let found = Peak::on(segment, 0.5, amount);
                self.rise((axis, derivative), found, rounding);
            }
        }
    }

    pub(crate) fn include_line(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let found = Peak::on(segment, 0.5, rate(segment, axis).abs());
            let rounding = rounding.of_rate(axis, segment);
            self.rise((axis, Derivative::Velocity), found, rounding);
        }
    }

    /// Includes the blend from one straight segment into the next: see [`AxesMotion`](crate::AxesMotion).
    pub(crate) fn include_blend(&mut self, [before, after]: [&Segment; 2], rounding: &Rounding) {
        let blend = 0.5 * (before.duration + after.duration);
        for axis in Axis::ALL {
            let change = (rate(after, axis) - rate(before, axis)).abs();
            let found = Peak::on(after, 0.0, change / blend);
            let rounding = rounding.of_rate(axis, before) + rounding.of_rate(axis, after);
            self.rise((axis, Derivative::Acceleration), found, rounding / blend);
        }
    }

    pub(crate) fn append(&mut self, next: &Self) {
        let all = self.largest.iter_mut().flatten();
        for (largest, next) in all.zip(next.largest.iter().flatten()) {
            *largest = largest.or(*next);
        }
    }
}

/// What an axis plays.
fn played(segment: &Segment, axis: Axis) -> &Cubic {
    match axis {
        Axis::C => &segment.c,
        Axis::X => &segment.x,
        Axis::Z => &segment.z,
    }
}

/// The rate of a straight segment.
fn rate(line: &Segment, axis: Axis) -> f64 {
    played(line, axis).slope(0.0) / line.duration
}
