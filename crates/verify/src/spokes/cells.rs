//! Cells: the angles of a mean turn that a segment passes, and the error at each of them.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::Cubic;

use super::turn::ANGLES;
use crate::instants::INSTANTS;

/// C follows a straight line if it leaves it by less than this part of the segment.
const STRAIGHT: f64 = 1e-9;
/// The part of C itself by which the rounding of both ends can bend a straight line.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Newton's method finds an instant to rounding in so many steps from the straight line.
const NEWTON_STEPS: usize = 5;
/// Cells on a radian.
pub(super) const PER_RADIAN: f64 = ANGLES as f64 / TAU;
/// So many cells go through the loop together at the most.
pub(super) const TOGETHER: usize = 64;

/// What was found at the instants of a segment.
pub(crate) trait SegmentErrors {
    /// Machined − wanted at an instant, mm; number [`INSTANTS`] is the end.
    fn error(&self, instant: usize) -> f64;

    /// The radius of the contact at an instant, mm.
    fn foot(&self, instant: usize) -> f64;
}

/// The cells of a segment.
pub(super) struct Cells<'a, S> {
    c: AngleCurve,
    found: &'a S,
    /// Only contacts at these radii count, mm.
    on_part: RangeInclusive<f64>,
}

/// C along a segment.
struct AngleCurve {
    played: Cubic,
    /// C at both ends, rad, as its control points have it.
    ends: [f64; 2],
    is_straight: bool,
}

impl<'a, S: SegmentErrors> Cells<'a, S> {
    /// The cells of a segment that plays `c` between these ends, rad.
    pub fn new(c: Cubic, ends: [f64; 2], found: &'a S, on_part: RangeInclusive<f64>) -> Self {
        let [start, rise, square, cube] = c.0;
        let straight = STRAIGHT * rise.abs() + ROUNDING * start.abs();
        let c = AngleCurve {
            played: c,
            ends,
            is_straight: square.abs() + cube.abs() <= straight,
        };
        Self { c, found, on_part }
    }

    /// The error in a cell, and the radius of its contact, mm; `None` where that lies beside the part.
    pub fn error(&self, cell: i64) -> Option<(f64, f64)> {
        let place = self.c.place(cell);
        let instant = instant_before(place);
        let foot = self.found.foot(instant);
        let error = FourErrors::around(instant, |instant| self.found.error(instant)).at(place);
        (self.on_part.contains(&foot) && error.is_finite()).then_some((error, foot))
    }

    /// The same for many cells: where they are found side by side.
    pub fn many(&self) -> ManyCells<'_> {
        let feet = std::array::from_fn(|instant| self.found.foot(instant));
        ManyCells {
            c: &self.c,
            errors: std::array::from_fn(|instant| self.found.error(instant)),
            feet,
            counts: feet.map(|foot| self.on_part.contains(&foot)),
        }
    }
}

/// The instants of a segment, for many of its cells.
pub(super) struct ManyCells<'a> {
    c: &'a AngleCurve,
    errors: [f64; INSTANTS + 1],
    feet: [f64; INSTANTS],
    /// Whether the contact at each instant lies on the part.
    counts: [bool; INSTANTS],
}

impl ManyCells<'_> {
    /// Writes the errors in the cells from number `first` on, [`TOGETHER`] at the most: NaN where no
    /// contact lies on the part. Gives the smallest and the largest radius of the others' contacts,
    /// mm; `None` if there are none.
    pub fn errors(&self, first: i64, errors: &mut [f64]) -> Option<[f64; 2]> {
        let seen = in_widest(Errors(self, first, errors));
        let instants = (0..INSTANTS).filter(|instant| seen >> instant & 1 == 1);
        let feet = instants.map(|instant| self.feet[instant]);
        feet.map(|foot| [foot, foot])
            .reduce(|range, foot| [range[0].min(foot[0]), range[1].max(foot[1])])
    }
}

impl AngleCurve {
    /// The place of a cell between the instants, counted in instants.
    #[inline(always)]
    fn place(&self, cell: i64) -> f64 {
        let c = cell as f64 / PER_RADIAN;
        let [start, end] = self.ends;
        let mut s = (c - start) / (end - start);
        if !self.is_straight {
            for _ in 0..NEWTON_STEPS {
                s -= (self.played.value(s) - c) / self.played.slope(s);
            }
        }
        INSTANTS as f64 * s.clamp(0.0, 1.0)
    }
}

/// The last instant up to a place.
#[inline(always)]
fn instant_before(place: f64) -> usize {
    (place as usize).min(INSTANTS - 1)
}

/// The errors at four instants in a row.
struct FourErrors {
    first: usize,
    errors: [f64; 4],
}

impl FourErrors {
    /// Those around what lies between an instant and the next one.
    #[inline(always)]
    fn around(instant: usize, error: impl Fn(usize) -> f64) -> Self {
        let first = instant.saturating_sub(1).min(INSTANTS - 3);
        Self {
            first,
            errors: std::array::from_fn(|k| error(first + k)),
        }
    }

    /// The error at a place: the cubic through the four.
    #[inline(always)]
    fn at(&self, place: f64) -> f64 {
        let [a, b, c, d] = self.errors;
        let u = place - self.first as f64;
        let third = d - 3.0 * (c - b) - a;
        let bend = c - 2.0 * b + a + (u - 2.0) / 3.0 * third;
        a + u * (b - a + 0.5 * (u - 1.0) * bend)
    }
}

/// The loop of [`ManyCells::errors`]. It gives a bit for each instant whose contact is that of a cell.
struct Errors<'a>(&'a ManyCells<'a>, i64, &'a mut [f64]);

impl Loop for Errors<'_> {
    type Output = u32;

    #[inline(always)]
    fn call(self) -> u32 {
        let Self(cells, first, errors) = self;
        // The places stand where the errors will.
        let places = &mut *errors;
        for (place, cell) in places.iter_mut().zip(first..) {
            *place = cells.c.place(cell);
        }
        let mut seen = 0;
        // All cells between two instants have the same four around them.
        for places in errors.chunk_by_mut(|one, next| instant_before(*one) == instant_before(*next))
        {
            let instant = places.first().map_or(0, |place| instant_before(*place));
            let known = FourErrors::around(instant, |instant| cells.errors[instant]);
            let counts = cells.counts[instant];
            let mut any_counts = false;
            for place in places {
                let found = known.at(*place);
                let counts = counts & found.is_finite();
                any_counts |= counts;
                *place = if counts { found } else { f64::NAN };
            }
            seen |= u32::from(any_counts) << instant;
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors and contacts without a pattern. The part ends among the contacts, and one error is none.
    struct Found;

    impl SegmentErrors for Found {
        fn error(&self, instant: usize) -> f64 {
            match instant {
                6 => f64::INFINITY,
                _ => 1e-6 * (0.1 + (7 * instant % 5) as f64),
            }
        }

        fn foot(&self, instant: usize) -> f64 {
            24.0 + 0.3 * (instant as f64 - 9.0).abs()
        }
    }

    #[test]
    fn a_cell_alone_has_the_error_that_it_has_among_many() {
        let (start, end) = (1.3, 1.3 + 70.5 / PER_RADIAN);
        let first = (start * PER_RADIAN).ceil() as i64;
        for swing in [0.0, 0.2] {
            let speed = end - start;
            let c = Cubic::hermite(
                start,
                (1.0 + swing) * speed,
                end,
                (1.0 - swing) * speed,
                1.0,
            );
            let cells = Cells::new(c, [start, end], &Found, 0.0..=25.0);
            let many = cells.many();
            let mut errors = [0.0; TOGETHER];
            let feet = many.errors(first, &mut errors);
            let alone: Vec<_> = (first..)
                .take(TOGETHER)
                .map(|cell| cells.error(cell))
                .collect();
            for (alone, error) in alone.iter().zip(errors) {
                let alone = alone.map_or(f64::NAN, |(error, _)| error);
                assert_eq!(alone.to_bits(), error.to_bits());
            }
            let each = || alone.iter().flatten().map(|(_, foot)| *foot);
            let range = [
                each().fold(f64::INFINITY, f64::min),
                each().fold(0.0, f64::max),
            ];
            assert_eq!(feet, Some(range));
            assert!(alone.iter().any(Option::is_none));
        }
    }
}
