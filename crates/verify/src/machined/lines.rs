//! The passes of a path, combined into lines through the axis.
//!
//! Passes stay in the blocks in which they come. A block has those of each section in a row, so a line
//! picks two rows from each block.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::sections::{Fan, Rows, SectionPasses};
use crate::cusp::Point;

/// Fewest sections that are kept. Half of them are lines through the axis.
const FEWEST: i64 = 2 * 23;
/// Number of passes that are kept, 16 bytes each, as long as there are more than the fewest sections. Beyond it, every
/// other section is dropped. From 87,000 turns on the fewest sections have more passes: a path of ten million turns
/// takes 7.4 GB.
const MOST_PASSES: usize = 4_000_000;

/// Passes along lines through the axis, each with a signed position: a pass of the section itself
/// at X, a pass of the opposite section at −X.
#[derive(Debug, Clone)]
pub struct Lines {
    fan: Fan,
    /// The number of one kept section to the number of the next.
    stride: i64,
    /// Passes of kept sections alone. The number of the first one is in strides.
    blocks: Vec<SectionPasses>,
    kept: usize,
}

/// The passes along one line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    /// Its angle, rad, 0 to 2π.
    pub angle: f64,
    /// Its number among the kept lines.
    number: i64,
    /// How many lines are kept: half of the sections of a turn.
    lines: i64,
    blocks: &'a [SectionPasses],
}

impl Lines {
    /// Lines without passes.
    pub fn new(fan: Fan) -> Self {
        Self {
            fan,
            stride: 1,
            blocks: Vec::new(),
            kept: 0,
        }
    }

    /// The sections of the lines.
    pub fn fan(&self) -> &Fan {
        &self.fan
    }

    /// Appends the passes of the path's next block.
    pub fn append(&mut self, mut next: SectionPasses) {
        next.keep_every(self.stride, self.fan.count);
        if next.centres.is_empty() {
            return;
        }
        self.kept += next.centres.len();
        self.blocks.push(next);
        while self.kept > MOST_PASSES && self.fan.count / self.stride > FEWEST {
            self.thin_out();
        }
    }

    /// Drops every other section.
    fn thin_out(&mut self) {
        let sections = self.fan.count / self.stride;
        let blocks = self.blocks.par_iter_mut();
        blocks.for_each(|block| block.keep_every(2, sections));
        self.stride *= 2;
        self.kept = self.blocks.iter().map(|block| block.centres.len()).sum();
    }

    /// All lines, in the order of their angles.
    pub(super) fn all(&self) -> Vec<Line<'_>> {
        let lines = self.fan.count / 2 / self.stride;
        let line = |number: i64| Line {
            angle: self.fan.angle(number * self.stride).rem_euclid(TAU),
            number,
            lines,
            blocks: &self.blocks,
        };
        (0..lines).map(line).collect()
    }
}

impl SectionPasses {
    /// Drops all passes but those of sections whose number is a multiple of `stride`, and counts in these.
    /// `sections` is how many a turn has.
    fn keep_every(&mut self, stride: i64, sections: i64) {
        if stride == 1 {
            return;
        }
        let rows = Rows {
            sections: sections as usize,
            passes: self.centres.len(),
        };
        let first_kept = (-self.first).rem_euclid(stride) as usize;
        let kept_rows = (first_kept..rows.sections).step_by(stride as usize);
        // A new list of just this size: one that shrinks in its place would leave a hole that the next
        // block does not fit into.
        let count = kept_rows.clone().map(|row| rows.places(row).len()).sum();
        let mut kept = Vec::with_capacity(count);
        for row in kept_rows {
            kept.extend_from_slice(self.centres.get(rows.places(row)).unwrap_or_default());
        }
        self.centres = kept;
        self.first = (self.first + first_kept as i64).div_euclid(stride);
    }
}

impl Line<'_> {
    /// Calls `take` with each pass: block by block those of the section, and those of the opposite one.
    fn for_each_pass(&self, mut take: impl FnMut(Point)) {
        for (sign, centres) in self.parts() {
            for centre in centres {
                take(Point::new(sign * centre.x, centre.y));
            }
        }
    }

    /// How many passes it has.
    fn count(&self) -> usize {
        self.parts().map(|(_, centres)| centres.len()).sum()
    }

    /// The passes of each block on the section and on the opposite one, with the sign of their positions.
    fn parts(&self) -> impl Iterator<Item = (f64, &[Point])> {
        let sections = 2 * self.lines;
        let sides = [(1.0, self.number), (-1.0, self.number + self.lines)];
        let blocks = self.blocks.iter();
        blocks.flat_map(move |block| {
            let rows = Rows {
                sections: sections as usize,
                passes: block.centres.len(),
            };
            sides.map(|(sign, section)| {
                let row = (section - block.first).rem_euclid(sections) as usize;
                let centres = block.centres.get(rows.places(row));
                (sign, centres.unwrap_or_default())
            })
        })
    }

    /// Sorts its passes into `sorted` from left to right, and those at the same position from the lowest
    /// up. Each half of the line is in order or nearly so, forward or backward.
    pub fn sort_into(&self, sorted: &mut Vec<Point>) {
        sorted.resize(self.count(), Point::default());
        let mut left = 0;
        let mut places = sorted.iter_mut();
        self.for_each_pass(|pass| {
            // As the order below has it, also for what is no number.
            let place = match pass.x.is_sign_negative() {
                true => {
                    left += 1;
                    places.next()
                }
                false => places.next_back(),
            };
            if let Some(place) = place {
                *place = pass;
            }
        });
        let (left, right) = sorted.split_at_mut(left);
        sort(left);
        sort(right);
    }
}

/// Sorts passes that are in order or nearly so, forward or backward.
fn sort(passes: &mut [Point]) {
    let in_order = |passes: &[Point]| passes.is_sorted_by(|one, next| one.x < next.x);
    let rows_backward = matches!(&*passes, [first, .., last] if first.x > last.x);
    if rows_backward {
        passes.reverse();
    }
    // Nearly all are in order now.
    if !in_order(passes) {
        passes.sort_by(|a, b| a.x.total_cmp(&b.x).then_with(|| a.y.total_cmp(&b.y)));
    }
}

#[cfg(test)]
impl Lines {
    /// One line at an angle, rad, with these passes.
    pub(super) fn of_line(angle: f64, passes: &[Point]) -> Self {
        let mut lines = Self::new(Fan::line(angle));
        let signs = [1.0, -1.0].into_iter().cycle();
        let on_sections: Vec<Point> = passes
            .iter()
            .zip(signs)
            .map(|(pass, sign)| Point::new(sign * pass.x, pass.y))
            .collect();
        lines.append(SectionPasses::by_section(&lines.fan, 0, &on_sections));
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes_of(line: &Line<'_>) -> Vec<Point> {
        let mut passes = Vec::new();
        line.for_each_pass(|pass| passes.push(pass));
        assert_eq!(passes.len(), line.count());
        passes
    }

    /// Passes in blocks of these lengths, from section −5 on, each with its number as its height.
    fn blocks(lengths: &[usize]) -> Vec<SectionPasses> {
        let mut first = -5;
        let block = |length: &usize| {
            let numbers = first..first + *length as i64;
            first = numbers.end;
            let passes: Vec<Point> = numbers.clone().map(|n| Point::new(1.0, n as f64)).collect();
            SectionPasses::by_section(&Fan::WHOLE, numbers.start, &passes)
        };
        lengths.iter().map(block).collect()
    }

    fn lines_of(blocks: Vec<SectionPasses>, stride: i64) -> Lines {
        let mut lines = Lines::new(Fan::WHOLE);
        while lines.stride < stride {
            lines.thin_out();
        }
        blocks.into_iter().for_each(|block| lines.append(block));
        lines
    }

    #[test]
    fn a_line_has_the_passes_of_its_section_and_of_the_opposite_one() {
        for stride in [1, 4] {
            let lines = lines_of(blocks(&[1, 700, 3, 0, 1500, 800]), stride);
            let all = lines.all();
            assert_eq!(all.len() as i64, Fan::WHOLE.count / 2 / stride);
            let mut seen = 0;
            for (index, line) in all.iter().enumerate() {
                let section = index as i64 * stride;
                assert_eq!(line.angle, Fan::WHOLE.angle(section));
                let expected = (-5..2999).filter_map(|n: i64| {
                    let within = n.rem_euclid(Fan::WHOLE.count);
                    let opposite = section + Fan::WHOLE.count / 2;
                    let sign = if within == section { 1.0 } else { -1.0 };
                    let is_of_line = within == section || within == opposite;
                    is_of_line.then(|| Point::new(sign, n as f64))
                });
                let mut found = passes_of(line);
                found.sort_by(|one, other| one.y.total_cmp(&other.y));
                assert_eq!(found, expected.collect::<Vec<_>>(), "{section}");
                seen += found.len();
            }
            assert_eq!(seen, lines.kept);
        }
    }

    #[test]
    fn dropping_sections_keeps_what_would_have_been_kept_from_the_start() {
        let lengths = [1, 700, 3, 0, 1500, 800];
        let mut late = lines_of(blocks(&lengths), 1);
        for stride in [2, 4, 8, 16] {
            late.thin_out();
            let early = lines_of(blocks(&lengths), stride);
            let with_passes = |lines: &Lines| -> Vec<SectionPasses> {
                let blocks = lines.blocks.iter();
                blocks
                    .filter(|block| !block.centres.is_empty())
                    .cloned()
                    .collect()
            };
            assert_eq!(with_passes(&late), with_passes(&early));
            assert_eq!((late.kept, late.stride), (early.kept, stride));
        }
    }

    /// Inward and outward, over the axis, with passes on each other: as one sort of all of them.
    #[test]
    fn passes_are_sorted_from_left_to_right_and_from_the_lowest_up() {
        let pass = |i: i32| Point::new(0.1 * f64::from(i), f64::from(i % 3));
        let both_ways = |i: i32| [pass(i), Point::new(-0.1 * f64::from(i) - 0.05, 1.0)];
        let inward: Vec<Point> = (-4..100).rev().flat_map(both_ways).collect();
        let outward: Vec<Point> = (0..100).flat_map(both_ways).collect();
        let twice = [inward.clone(), outward.clone()].concat();
        let at_axis = [0.0, -0.0, 0.0].map(|x| Point::new(x, -x)).to_vec();
        let no_number = [f64::NAN, -f64::NAN].map(|x| Point::new(x, 0.0));
        let unknown = vec![pass(3), no_number[0], pass(-2), no_number[1], pass(1)];
        for passes in [inward, outward, twice, at_axis, unknown, Vec::new()] {
            let lines = Lines::of_line(0.3, &passes);
            let [line] = lines.all()[..] else {
                panic!("one line");
            };
            let mut found = vec![pass(7)];
            line.sort_into(&mut found);
            let mut expected = passes_of(&line);
            expected.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            let bits = |passes: &[Point]| -> Vec<[u64; 2]> {
                passes
                    .iter()
                    .map(|pass| [pass.x, pass.y].map(f64::to_bits))
                    .collect()
            };
            assert_eq!(bits(&found), bits(&expected));
        }
    }
}
