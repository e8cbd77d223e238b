//! Cells: the angles of a mean turn that a segment passes, and the error at each of them.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::Segment;

use super::turn::ANGLES;
use crate::instants::INSTANTS;

/// C follows a straight line if it leaves it by less than this part of the segment.
const STRAIGHT: f64 = 1e-9;
/// Newton's method finds an instant to rounding in so many steps from the straight line.
const NEWTON_STEPS: usize = 5;
/// Cells on a radian.
pub(super) const PER_RADIAN: f64 = ANGLES as f64 / TAU;
/// So many cells go through the loop together at the most.
pub(super) const TOGETHER: usize = 64;

/// What was found on one segment.
pub(crate) struct SegmentErrors<'a> {
    /// What is played.
    pub segment: &'a Segment,
    /// C at both ends, rad, as its control points have it.
    pub ends: [f64; 2],
    /// Machined − wanted at each instant and at the end, mm.
    pub errors: [f64; INSTANTS + 1],
    /// The radius of the contact at each instant, mm.
    pub feet: [f64; INSTANTS],
}

/// The cells of a segment.
pub(super) struct Cells<'a> {
    found: &'a SegmentErrors<'a>,
    is_straight: bool,
    /// Whether the contact at each instant lies on the part.
    counts: [bool; INSTANTS],
}

impl<'a> Cells<'a> {
    /// The cells of a segment. Only contacts at these radii count, mm.
    pub fn new(found: &'a SegmentErrors<'a>, on_part: &RangeInclusive<f64>) -> Self {
        let [_, rise, square, cube] = found.segment.c.0;
        Self {
            found,
            is_straight: square.abs() + cube.abs() <= STRAIGHT * rise.abs(),
            counts: found.feet.map(|foot| on_part.contains(&foot)),
        }
    }

    /// Writes the errors in the cells from number `first` on, [`TOGETHER`] at the most: NaN where no
    /// contact lies on the part. Gives the smallest and the largest radius of the others' contacts,
    /// mm; `None` if there are none.
    pub fn errors(&self, first: i64, errors: &mut [f64]) -> Option<[f64; 2]> {
        let seen = in_widest(Errors(self, first, errors));
        let instants = (0..INSTANTS).filter(|instant| seen >> instant & 1 == 1);
        let feet = instants.map(|instant| self.found.feet[instant]);
        feet.map(|foot| [foot, foot])
            .reduce(|range, foot| [range[0].min(foot[0]), range[1].max(foot[1])])
    }

    /// The place between the instants, counted in instants, where C is `c`.
    #[inline(always)]
    fn place(&self, c: f64) -> f64 {
        let [start, end] = self.found.ends;
        let mut s = (c - start) / (end - start);
        if !self.is_straight {
            let played = &self.found.segment.c;
            for _ in 0..NEWTON_STEPS {
                s -= (played.value(s) - c) / played.slope(s);
            }
        }
        INSTANTS as f64 * s.clamp(0.0, 1.0)
    }

    /// The error at a place: the cubic through the four values around it.
    #[inline(always)]
    fn error_at(&self, place: f64) -> f64 {
        let first = (place as usize).saturating_sub(1).min(INSTANTS - 3);
        let errors = &self.found.errors;
        let (a, b, c, d) = (
            errors[first],
            errors[first + 1],
            errors[first + 2],
            errors[first + 3],
        );
        let u = place - first as f64;
        let third = d - 3.0 * (c - b) - a;
        let bend = c - 2.0 * b + a + (u - 2.0) / 3.0 * third;
        a + u * (b - a + 0.5 * (u - 1.0) * bend)
    }
}

/// The loop of [`Cells::errors`]. It gives a bit for each instant whose contact is that of a cell.
struct Errors<'a>(&'a Cells<'a>, i64, &'a mut [f64]);

impl Loop for Errors<'_> {
    type Output = u32;

    #[inline(always)]
    fn call(self) -> u32 {
        let Self(cells, first, errors) = self;
        // The places stand where the errors will.
        let places = &mut *errors;
        for (place, cell) in places.iter_mut().zip(first..) {
            *place = cells.place(cell as f64 / PER_RADIAN);
        }
        let mut seen = 0;
        for error in errors {
            let place = *error;
            let instant = (place as usize).min(INSTANTS - 1);
            let found = cells.error_at(place);
            let counts = cells.counts[instant] && found.is_finite();
            seen |= u32::from(counts) << instant;
            *error = if counts { found } else { f64::NAN };
        }
        seen
    }
}
