//! Segments in a row of which each is one line of a program.

use crate::digit_columns::DigitColumns;
use crate::digits::{DigitSegment, Digits, said_positions, turn};
use crate::program_format::ProgramFormat;

/// Segments from control point to control point, none of them divided.
#[derive(Debug, Clone, Copy)]
pub struct DigitSegments<'a> {
    /// Where the first one begins.
    before: Digits,
    /// The steps of the segment before it.
    steps_before: Option<i64>,
    /// Where they end.
    ends: &'a DigitColumns,
    count: usize,
}

impl<'a> DigitSegments<'a> {
    /// The segments that end at the first `count` of these points. `None` where a program does not carry each of
    /// them as one line.
    pub(crate) fn new(
        format: &ProgramFormat,
        (before, steps_before): (Digits, Option<i64>),
        (ends, count): (&'a DigitColumns, usize),
    ) -> Option<Self> {
        let segments = Self {
            before,
            steps_before,
            ends,
            count,
        };
        let are_good = segments.have_good_steps(format)? && segments.have_good_turns(format)?;
        (count > 0 && are_good).then_some(segments)
    }

    /// Whether all of them take a time that a segment may take.
    fn have_good_steps(&self, format: &ProgramFormat) -> Option<bool> {
        let times = format.shortest.max(1)..=format.longest;
        let steps = self.ends.steps().get(..self.count)?;
        Some(all_pairs(self.before.steps, steps, |from, to| {
            times.contains(&(to - from))
        }))
    }

    /// Whether C reaches all of their ends, and a reader finds the turn of each.
    fn have_good_turns(&self, format: &ProgramFormat) -> Option<bool> {
        let [before, _, _] = self.before.position;
        let [c, _, _] = self.ends.positions();
        let c = c.get(..self.count)?;
        let half_turn = turn(format) / 2;
        Some(match (format.c_wrapped, format.c_limit) {
            (true, _) if format.incremental => true,
            (true, _) => all_pairs(before, c, |from, to| (to - from).abs() < half_turn),
            (false, Some(limit)) => {
                all_pairs(before, c, |_, to| to.unsigned_abs() <= limit.unsigned_abs())
            }
            (false, None) => true,
        })
    }

    /// How many there are: at least one.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Where they end.
    pub(crate) fn ends(&self) -> &'a DigitColumns {
        self.ends
    }

    /// The highest Z of their ends, in last digits.
    pub(crate) fn highest(&self) -> Option<i64> {
        let [_, _, z] = self.ends.positions();
        z.get(..self.count)?.iter().copied().max()
    }

    /// One of them.
    pub(crate) fn segment(&self, index: usize) -> Option<DigitSegment> {
        let end = |index: usize| self.ends.at(index);
        let from = match index {
            0 => self.before,
            _ => end(index - 1)?,
        };
        Some(DigitSegment {
            from,
            to: end(index)?,
            steps_before: self.steps_before(index),
        })
    }

    /// The steps of the segment before one of them.
    pub(crate) fn steps_before(&self, index: usize) -> Option<i64> {
        match index {
            0 => self.steps_before,
            _ => self.steps(index - 1),
        }
    }

    /// The steps of one of them.
    pub(crate) fn steps(&self, index: usize) -> Option<i64> {
        let steps = self.ends.steps();
        let from = match index {
            0 => self.before.steps,
            _ => *steps.get(index - 1)?,
        };
        Some(steps.get(index)? - from)
    }

    /// All of them in their order.
    pub fn segments(&self) -> impl Iterator<Item = DigitSegment> + '_ {
        (0..self.count).map_while(|index| self.segment(index))
    }

    /// The positions that the lines of segments `first` and on say, as columns of C, X and Z: zeros behind the last
    /// segment.
    pub(crate) fn said_positions<const COUNT: usize>(
        &self,
        format: &ProgramFormat,
        first: usize,
    ) -> Option<[[i64; COUNT]; 3]> {
        let mut said = [[0; COUNT]; 3];
        let numbers = first..self.count.min(first + COUNT);
        if format.incremental || format.c_wrapped {
            for (place, index) in numbers.enumerate() {
                let positions = said_positions(format, &self.segment(index)?);
                for (said, position) in said.iter_mut().zip(positions) {
                    *said.get_mut(place)? = position;
                }
            }
        } else {
            for (said, positions) in said.iter_mut().zip(self.ends.positions()) {
                let positions = positions.get(numbers.clone())?;
                said.get_mut(..positions.len())?.copy_from_slice(positions);
            }
        }
        Some(said)
    }
}

/// Whether a test holds for each value of a column and the one before it.
fn all_pairs(before: i64, column: &[i64], test: impl Fn(i64, i64) -> bool) -> bool {
    let mut from = before;
    let mut all = true;
    for to in column {
        all &= test(from, *to);
        from = *to;
    }
    all
}
