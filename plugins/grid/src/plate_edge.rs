//! The forces of numbers at the edges of a sheet, where some differences would reach beyond it.
//!
//! A strip along an edge has six lines, of which the forces of three are calculated. Differences that reach
//! beyond the sheet are zero there, so all numbers of a line have one formula, and go through the registers
//! together.

use std::ops::Range;

use crate::differences::{Difference, Differences, KINDS, REACH};

/// Lines of a strip: those whose forces are calculated, and those that their differences reach.
const LINES: usize = 2 * REACH;

/// Numbers of a line that are calculated together.
const TOGETHER: usize = 16;

/// The strips along the edges in which some numbers lie.
pub struct EdgeStrips {
    columns: usize,
    strips: Vec<Strip>,
}

impl EdgeStrips {
    /// The strips of the numbers at `places`, which lie at edges.
    pub fn of(sheet: &Differences, places: &[usize]) -> Self {
        let columns = sheet.columns;
        let mut strips = Strip::all(sheet);
        let place = |place: &usize| (place / columns, place % columns);
        strips.retain(|strip| {
            let mut places = places.iter().map(place);
            places.any(|(row, column)| strip.has(row, column))
        });
        Self { columns, strips }
    }

    /// Puts half the derivatives by the numbers of the strips into their places.
    #[inline(always)]
    pub fn put(&mut self, values: &[f64], forces: &mut [f64]) {
        for strip in &mut self.strips {
            strip.take_values(values, self.columns);
            for kind in &mut strip.kinds {
                kind.take_differences(&strip.values, strip.length);
            }
            for line in 0..strip.forced.len() {
                for at in strip.along.clone().step_by(TOGETHER) {
                    let together = strip.forces(line, at);
                    let group = at..strip.along.end.min(at + TOGETHER);
                    for (force, at) in together.into_iter().zip(group) {
                        forces[strip.place(strip.forced.start + line, at, self.columns)] = force;
                    }
                }
            }
        }
    }
}

/// Lines along an edge: rows, or columns.
struct Strip {
    /// Whether the lines are columns.
    is_upright: bool,
    /// The row or column of the first line.
    first: usize,
    /// Its lines.
    lines: usize,
    /// Numbers of a line.
    length: usize,
    /// The lines whose forces are calculated.
    forced: Range<usize>,
    /// Where these forces lie along their lines.
    along: Range<usize>,
    /// The numbers, one line after the other, and zeros for a group that goes on behind the last one.
    values: Vec<f64>,
    kinds: [Kind; KINDS],
}

impl Strip {
    /// All strips of a sheet. A sheet with fewer lines than a strip is one; the sheets of maps have more.
    fn all(sheet: &Differences) -> Vec<Self> {
        let Differences { columns, rows, .. } = *sheet;
        if columns.min(rows) < LINES {
            let is_upright = columns < rows;
            let [lines, length] = [columns.min(rows), columns.max(rows)];
            return vec![Self::new(sheet, is_upright, 0, 0..lines, 0..length)];
        }
        let (near, far) = (0..REACH, REACH..LINES);
        // The corners belong to the rows.
        let between = REACH..rows - REACH;
        vec![
            Self::new(sheet, false, 0, near.clone(), 0..columns),
            Self::new(sheet, false, rows - LINES, far.clone(), 0..columns),
            Self::new(sheet, true, 0, near, between.clone()),
            Self::new(sheet, true, columns - LINES, far, between),
        ]
    }

    fn new(
        sheet: &Differences,
        is_upright: bool,
        first: usize,
        forced: Range<usize>,
        along: Range<usize>,
    ) -> Self {
        let [across, length] = match is_upright {
            true => [sheet.columns, sheet.rows],
            false => [sheet.rows, sheet.columns],
        };
        let lines = across.min(LINES);
        let kinds = sheet.kinds.each_ref();
        Self {
            is_upright,
            first,
            lines,
            length,
            values: vec![0.0; lines * length + TOGETHER],
            kinds: kinds.map(|kind| Kind::of(kind, is_upright, lines, length, &forced)),
            forced,
            along,
        }
    }

    /// Whether the force of a number is calculated.
    fn has(&self, row: usize, column: usize) -> bool {
        let (line, at) = match self.is_upright {
            true => (column, row),
            false => (row, column),
        };
        let line = line.checked_sub(self.first);
        line.is_some_and(|line| self.forced.contains(&line)) && self.along.contains(&at)
    }

    /// The place of number `at` of a line in the sheet.
    #[inline(always)]
    fn place(&self, line: usize, at: usize, columns: usize) -> usize {
        match self.is_upright {
            true => at * columns + self.first + line,
            false => (self.first + line) * columns + at,
        }
    }

    #[inline(always)]
    fn take_values(&mut self, values: &[f64], columns: usize) {
        let lines = self.values.chunks_exact_mut(self.length).take(self.lines);
        for (line, number) in lines.zip(self.first..) {
            if self.is_upright {
                let column = values.iter().skip(number).step_by(columns);
                line.iter_mut()
                    .zip(column)
                    .for_each(|(own, value)| *own = *value);
            } else {
                line.copy_from_slice(&values[number * columns..][..columns]);
            }
        }
    }

    /// The forces of neighbours in a line, from number `at` on.
    #[inline(always)]
    fn forces(&self, line: usize, at: usize) -> [f64; TOGETHER] {
        let mut forces = [0.0; TOGETHER];
        for kind in &self.kinds {
            let sums = products(&kind.counted[line], &kind.differences, at);
            for (force, sum) in forces.iter_mut().zip(sums) {
                *force += kind.weight * sum;
            }
        }
        forces
    }
}

/// One kind of differences in a strip.
struct Kind {
    weight: f64,
    /// The numbers of a difference, from the place of its first one on.
    terms: Vec<Term>,
    /// How far the last number of a difference lies behind its first one along a line.
    span: usize,
    /// The lines on which differences begin that count.
    begins: Range<usize>,
    /// The differences that begin on each line, behind [`REACH`] zeros. Zeros follow them.
    differences: Vec<f64>,
    /// Numbers that a line of differences takes.
    stride: usize,
    /// For each line whose forces are calculated: where the differences lie that contain a number of it, counted
    /// from the number's place in the line.
    counted: Vec<Vec<Term>>,
}

/// One term of a sum over numbers.
struct Term {
    /// How far its number lies behind the place of the sum.
    offset: usize,
    factor: f64,
}

impl Kind {
    fn of(
        difference: &Difference,
        is_upright: bool,
        lines: usize,
        length: usize,
        forced: &Range<usize>,
    ) -> Self {
        let [of_x, of_y] = &difference.along;
        let [under, behind] = match is_upright {
            true => [of_x.len() - 1, of_y.len() - 1],
            false => [of_y.len() - 1, of_x.len() - 1],
        };
        // How many lines and numbers each number of a difference lies behind the first one.
        let numbers = || {
            let rows = of_y.iter().enumerate();
            rows.flat_map(|(down, y)| {
                let row = of_x.iter().enumerate();
                row.map(move |(right, x)| match is_upright {
                    true => (right, down, x * y),
                    false => (down, right, x * y),
                })
            })
        };
        let stride = REACH + length + TOGETHER;
        let begins =
            forced.start.saturating_sub(under)..forced.end.min(lines.saturating_sub(under));
        let terms = numbers().map(|(under, behind, factor)| Term {
            offset: under * length + behind,
            factor,
        });
        let counted = |line: usize| {
            let counted = numbers().filter_map(|(under, behind, factor)| {
                let begin = line
                    .checked_sub(under)
                    .filter(|begin| begins.contains(begin))?;
                // The zeros before a line are as many as a difference reaches.
                let offset = begin * stride + REACH - behind;
                Some(Term { offset, factor })
            });
            counted.collect()
        };
        Self {
            weight: difference.weight,
            terms: terms.collect(),
            span: behind,
            differences: vec![0.0; lines * stride + TOGETHER],
            stride,
            counted: forced.clone().map(counted).collect(),
            begins,
        }
    }

    /// Takes all differences from the numbers of the strip. Those that would reach beyond it stay zero.
    #[inline(always)]
    fn take_differences(&mut self, values: &[f64], length: usize) {
        let count = length.saturating_sub(self.span);
        for line in self.begins.clone() {
            let start = line * self.stride + REACH;
            let differences = &mut self.differences[start..start + length + TOGETHER];
            for at in (0..count).step_by(TOGETHER) {
                let group = products(&self.terms, values, line * length + at);
                differences[at..at + TOGETHER].copy_from_slice(&group);
            }
            differences[count..].fill(0.0);
        }
    }
}

/// Sums of numbers times their factors, for the number at `at` and for those behind it.
#[inline(always)]
fn products(terms: &[Term], numbers: &[f64], at: usize) -> [f64; TOGETHER] {
    let mut sums = [0.0; TOGETHER];
    for Term { offset, factor } in terms {
        for (sum, number) in sums.iter_mut().zip(&numbers[at + offset..][..TOGETHER]) {
            *sum += factor * number;
        }
    }
    sums
}

/// The runs of neighbours among places that are in order.
pub fn runs(places: impl IntoIterator<Item = usize>) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for place in places {
        match runs.last_mut().filter(|run| run.end == place) {
            Some(run) => run.end += 1,
            None => runs.push(place..place + 1),
        }
    }
    runs
}
