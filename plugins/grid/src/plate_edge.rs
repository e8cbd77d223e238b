//! The forces of numbers at the edges of a sheet, where some differences would reach beyond it.
//!
//! A difference counts in the forces of up to six numbers. So each is taken once.

use std::ops::Range;

use crate::differences::{Difference, Differences, KINDS, REACH, starts};

/// Some numbers at the edges, and the differences that contain them.
pub struct AtEdge {
    places: Vec<usize>,
    /// How each number lies to the edges, as [`class`] says.
    classes: Vec<u8>,
    kinds: [Kind; KINDS],
}

/// One kind of differences.
struct Kind {
    weight: f64,
    /// How far the numbers of a difference lie behind its first one, and their factors.
    terms: Vec<(usize, f64)>,
    /// The places of the first numbers.
    firsts: Vec<Range<usize>>,
    /// The differences, in this order.
    differences: Vec<f64>,
    /// The differences that count in the force of each number, one number after the other.
    parts: Vec<u32>,
    /// What they count in the forces of numbers of each class.
    factors: [Vec<f64>; CLASSES],
}

/// Distances from the edges along one axis that differ: three numbers on either side, and all between.
const DISTANCES: usize = 2 * REACH + 1;

/// Ways to lie to the edges.
const CLASSES: usize = DISTANCES * DISTANCES;

/// How a place lies to the edges of a sheet. All numbers of one class count alike in their differences.
fn class(sheet: &Differences, place: usize) -> u8 {
    let along = |at: usize, count: usize| at.min(REACH) + REACH - (count - 1 - at).min(REACH);
    let row = along(place / sheet.columns, sheet.rows);
    let column = along(place % sheet.columns, sheet.columns);
    (row * DISTANCES + column) as u8
}

impl AtEdge {
    /// Some numbers, by their places.
    pub fn of(sheet: &Differences, places: Vec<usize>) -> Self {
        let kinds = sheet.kinds.each_ref();
        Self {
            classes: places.iter().map(|place| class(sheet, *place)).collect(),
            kinds: kinds.map(|difference| Kind::of(sheet, difference, &places)),
            places,
        }
    }

    /// Puts half the derivatives by the numbers into their places.
    #[inline(always)]
    pub fn put(&mut self, values: &[f64], forces: &mut [f64]) {
        for place in &self.places {
            forces[*place] = 0.0;
        }
        for kind in &mut self.kinds {
            kind.take_differences(values);
            let mut parts = kind.parts.iter();
            for (place, class) in self.places.iter().zip(&self.classes) {
                let mut sum = 0.0;
                // The factors come first in the pair, so that no part is taken at their end.
                for (factor, part) in kind.factors[usize::from(*class)].iter().zip(&mut parts) {
                    sum += factor * kind.differences[*part as usize];
                }
                forces[*place] += kind.weight * sum;
            }
        }
    }
}

impl Kind {
    fn of(sheet: &Differences, difference: &Difference, places: &[usize]) -> Self {
        let Difference { along, weight } = difference;
        let [of_x, of_y] = along;
        let columns = sheet.columns;
        // The first numbers of all differences that contain a number, and its factors in them.
        let containing = |place: &usize| {
            let (row, column) = (place / columns, place % columns);
            starts(row, sheet.rows, of_y).flat_map(move |(down, factor_y)| {
                let across = starts(column, columns, of_x);
                across.map(move |(right, factor_x)| (down * columns + right, factor_x * factor_y))
            })
        };
        let mut is_first = vec![false; columns * sheet.rows];
        for (first, _) in places.iter().flat_map(containing) {
            is_first[first] = true;
        }
        let firsts = runs((0..is_first.len()).filter(|place| is_first[*place]));
        let ends: Vec<usize> = firsts
            .iter()
            .scan(0, |end, run| {
                *end += run.len();
                Some(*end)
            })
            .collect();
        let number = |first: usize| {
            let run = firsts.partition_point(|run| run.end <= first);
            // The sheet of the largest map has far fewer than 2³² numbers.
            (ends[run] - (firsts[run].end - first)) as u32
        };
        let parts = places
            .iter()
            .flat_map(containing)
            .map(|(first, _)| number(first));
        let parts: Vec<u32> = parts.collect();
        let mut factors = [const { Vec::new() }; CLASSES];
        for place in places {
            let factors = &mut factors[usize::from(class(sheet, *place))];
            if factors.is_empty() {
                factors.extend(containing(place).map(|(_, factor)| factor));
            }
        }
        let line = |(down, y): (usize, &f64)| {
            let y = *y;
            let numbers = of_x.iter().enumerate();
            numbers.map(move |(right, x)| (down * columns + right, x * y))
        };
        Self {
            weight: *weight,
            terms: of_y.iter().enumerate().flat_map(line).collect(),
            differences: vec![0.0; ends.last().copied().unwrap_or(0)],
            firsts,
            parts,
            factors,
        }
    }

    #[inline(always)]
    fn take_differences(&mut self, values: &[f64]) {
        let mut begin = 0;
        for firsts in &self.firsts {
            let differences = &mut self.differences[begin..begin + firsts.len()];
            differences.fill(0.0);
            for (behind, factor) in &self.terms {
                let numbers = &values[firsts.start + behind..firsts.end + behind];
                for (difference, value) in differences.iter_mut().zip(numbers) {
                    *difference += factor * value;
                }
            }
            begin += firsts.len();
        }
    }
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
