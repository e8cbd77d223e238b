//! The forces of numbers at the edges of a sheet, where some differences would reach beyond it.
//!
//! A difference counts in the forces of up to six numbers. So each is taken once.

use std::ops::Range;

use crate::plate::{Difference, KINDS, Plate, starts};

/// Some numbers at the edges, and the differences that contain them.
pub struct AtEdge {
    places: Vec<usize>,
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
    /// What the force of each place takes from which differences, place after place.
    parts: Vec<(u32, f64)>,
    /// Where the parts of each place end.
    ends: Vec<usize>,
}

impl AtEdge {
    /// Some numbers, by their places.
    pub fn of(plate: &Plate, places: Vec<usize>) -> Self {
        let kinds = plate.differences.each_ref();
        Self {
            kinds: kinds.map(|difference| Kind::of(plate, difference, &places)),
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
            let mut begin = 0;
            for (place, end) in self.places.iter().zip(&kind.ends) {
                let mut sum = 0.0;
                for (difference, factor) in &kind.parts[begin..*end] {
                    sum += factor * kind.differences[*difference as usize];
                }
                forces[*place] += kind.weight * sum;
                begin = *end;
            }
        }
    }
}

impl Kind {
    fn of(plate: &Plate, difference: &Difference, places: &[usize]) -> Self {
        let Difference { along, weight } = difference;
        let [of_x, of_y] = along;
        let columns = plate.columns;
        let containing = |place: &usize| {
            let (row, column) = (place / columns, place % columns);
            starts(row, plate.rows, of_y).flat_map(move |(down, factor_y)| {
                let across = starts(column, columns, of_x);
                across.map(move |(right, factor_x)| (down * columns + right, factor_x * factor_y))
            })
        };
        let mut firsts: Vec<usize> = places
            .iter()
            .flat_map(containing)
            .map(|(first, _)| first)
            .collect();
        firsts.sort_unstable();
        firsts.dedup();
        let (mut parts, mut ends) = (Vec::new(), Vec::with_capacity(places.len()));
        for place in places {
            for (first, factor) in containing(place) {
                let number = firsts.partition_point(|other| *other < first);
                parts.push((number as u32, factor));
            }
            ends.push(parts.len());
        }
        let line = |(down, y): (usize, &f64)| {
            let y = *y;
            let numbers = of_x.iter().enumerate();
            numbers.map(move |(right, x)| (down * columns + right, x * y))
        };
        Self {
            weight: *weight,
            terms: of_y.iter().enumerate().flat_map(line).collect(),
            differences: vec![0.0; firsts.len()],
            firsts: runs(firsts),
            parts,
            ends,
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
pub fn runs(places: Vec<usize>) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for place in places {
        match runs.last_mut().filter(|run| run.end == place) {
            Some(run) => run.end += 1,
            None => runs.push(place..place + 1),
        }
    }
    runs
}
