//! When C passes sections at equal distances.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::Segment;

/// Steps of Newton's method for the instant at which C passes a section. C is nearly linear.
const STEPS: usize = 8;
/// So many sections go through the loop together at the most.
const TOGETHER: usize = 32;
/// Most sections for which a list has room at its beginning: those of a block of 64 turns and more. A
/// longer list grows.
const MOST_ROOM: usize = 1 << 16;

/// Sections at equal distances around the axis, numbered from C = offset on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sections {
    /// C of section 0, rad.
    pub offset: f64,
    /// From one section to the next, rad.
    pub width: f64,
}

impl Sections {
    /// About how many sections C passes from the first of these values to the last one, rad, for a list
    /// that has room for them: never very many.
    pub fn about(&self, c: &[f64]) -> usize {
        let extent = c
            .last()
            .zip(c.first())
            .map_or(0.0, |(last, first)| last - first);
        // What is no number is no room.
        ((extent / self.width) as usize).min(MOST_ROOM) + 1
    }

    /// Calls `take` with the number of each section that a segment passes, its end excluded, and the
    /// instant at which C passes it, as a part of the segment. `ends` are C at both ends, rad.
    pub fn crossings(&self, segment: &Segment, ends: [f64; 2], mut take: impl FnMut(i64, f64)) {
        let [from, end] = ends.map(|c| (c - self.offset) / self.width);
        let mut number = from.ceil();
        while number < end {
            let count = (end - number).ceil().min(TOGETHER as f64);
            let mut instants = [0.0; TOGETHER];
            let instants = &mut instants[..count as usize];
            for (i, angle) in instants.iter_mut().enumerate() {
                *angle = self.offset + (number + i as f64) * self.width;
            }
            in_widest(Crossings(segment, instants));
            for (number, instant) in (number as i64..).zip(instants.iter()) {
                take(number, *instant);
            }
            number += count;
        }
    }
}

/// The instant at which C passes `angle`, as a part of the segment, 0 to 1.
pub(crate) fn crossing(segment: &Segment, angle: f64) -> f64 {
    let mut instant = [angle];
    Crossings(segment, &mut instant).call();
    let [instant] = instant;
    instant
}

/// The loop that turns angles into the instants at which C passes them.
struct Crossings<'a>(&'a Segment, &'a mut [f64]);

impl Loop for Crossings<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(segment, angles) = self;
        let (from, to) = (segment.c.value(0.0), segment.c.value(1.0));
        let mut instants = [0.0; TOGETHER];
        for (s, angle) in instants.iter_mut().zip(angles.iter()) {
            *s = (angle - from) / (to - from);
        }
        for _ in 0..STEPS {
            let mut moved = false;
            for (s, angle) in instants.iter_mut().zip(angles.iter()) {
                let step = (segment.c.value(*s) - angle) / segment.c.slope(*s);
                let next = match step.is_finite() {
                    true => (*s - step).clamp(0.0, 1.0),
                    false => *s,
                };
                moved |= next != *s;
                *s = next;
            }
            if !moved {
                break;
            }
        }
        for (angle, s) in angles.iter_mut().zip(instants) {
            *angle = s;
        }
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    /// The speed swings by a third, so that C is far from linear.
    #[test]
    fn c_is_that_of_each_section_and_no_section_is_left_out() {
        let point = |t: f64, vc: f64| ControlPoint {
            t,
            c: 10.0 + 3.0 * t,
            vc,
            ..ControlPoint::default()
        };
        let segment = Segment::between(&point(0.0, 2.0), &point(1.0, 4.0));
        for width in [0.017, 0.3, 5.0] {
            let sections = Sections { offset: 0.1, width };
            let mut numbers = Vec::new();
            sections.crossings(&segment, [10.0, 13.0], |number, instant| {
                let c = 0.1 + number as f64 * width;
                assert!((segment.c.value(instant) - c).abs() < 1e-13, "{c}");
                assert_eq!(instant.to_bits(), crossing(&segment, c).to_bits());
                numbers.push(number);
            });
            let passed = (0..1000).filter(|i| {
                let c = 0.1 + f64::from(*i) * width;
                (10.0..13.0).contains(&c)
            });
            assert_eq!(numbers, passed.map(i64::from).collect::<Vec<_>>());
        }
    }
}
