//! The columns or the rows of a grid, found from the coordinates of its points.
//!
//! Coordinates are rounded, so distances of neighbouring columns differ. They are counted in pitches
//! one by one, and the grid is the straight line that fits all columns best.

use std::collections::HashSet;

use crate::error::Short;

/// How far a point may lie off its place in the grid, in pitches. A larger share would take an uneven
/// grid for an even one.
const LARGEST_SHIFT: f64 = 0.01;

/// The same, in units of the last digit that is written. Rounding takes a half; the rest is for the
/// grid itself, which is known only from rounded coordinates.
const ROUNDED: f64 = 0.6;

/// How far a point may lie off its place at the most, in pitches, however few digits are written: two
/// neighbours at this distance are still told from two that miss one between them.
const COARSEST: f64 = 0.1;

/// Coordinates that are nearer than this share of the largest gap are one column, rounded.
const SAME: f64 = 0.02;

/// Gaps below this multiple of the least one are of neighbouring columns.
const NEIGHBOURS: f64 = 1.5;

/// Most columns (rows) of a grid for each one that has a point.
const MOST_EMPTY: usize = 2;

/// The columns or the rows of a grid, in the file's unit.
pub struct Axis {
    first: f64,
    /// Distance of neighbours.
    pub pitch: f64,
    /// How many there are.
    pub count: usize,
    /// How far a point may lie off its place, in pitches.
    shift: f64,
}

/// Coordinates that are those of no even grid.
pub struct UnevenAxis {
    /// What is wrong.
    pub what: String,
    /// A coordinate that shows it.
    pub value: f64,
}

impl Axis {
    /// The columns (rows) to which all coordinates belong. `last_digit` is the power of ten of the
    /// last digit that is written.
    pub fn of(values: impl Iterator<Item = f64>, last_digit: i32) -> Result<Self, UnevenAxis> {
        let all = sorted(values);
        let columns = columns(&all);
        let [first, .., last] = columns.as_slice() else {
            let what = "all points have the same place".to_owned();
            let value = all.first().copied().unwrap_or(0.0);
            return Err(UnevenAxis { what, value });
        };
        let mut pitch = neighbours(&columns);
        // Whole columns may be holes, but not most of them.
        if (last - first) / pitch > (MOST_EMPTY * columns.len()) as f64 {
            return Err(unlike_gaps(&columns));
        }
        let mut axis = Self::fitted(&columns, pitch);
        // Wide gaps are counted better with the pitch of all columns.
        pitch = axis.pitch;
        axis = Self::fitted(&columns, pitch);
        let digit: f64 = format!("1e{last_digit}").parse().unwrap_or(0.0);
        axis.shift = (ROUNDED * digit / axis.pitch).clamp(LARGEST_SHIFT, COARSEST);
        let worst = |one: &&f64, other: &&f64| axis.off(**one).total_cmp(&axis.off(**other));
        match all.iter().max_by(worst) {
            Some(value) if axis.off(*value) > axis.shift => Err(UnevenAxis {
                what: format!(
                    "{} lies off its place by {} % of the pitch {}, and may by {} %",
                    Short(*value),
                    Short(100.0 * axis.off(*value)),
                    Short(axis.pitch),
                    Short(100.0 * axis.shift),
                ),
                value: *value,
            }),
            _ => Ok(axis),
        }
    }

    /// The straight line through columns that are counted in pitches.
    fn fitted(columns: &[f64], pitch: f64) -> Self {
        let mut number = 0.0;
        let steps = columns.windows(2).map(|pair| match pair {
            [one, next] => ((next - one) / pitch).round(),
            _ => 0.0,
        });
        let numbers: Vec<f64> = std::iter::once(0.0)
            .chain(steps)
            .map(|step| {
                number += step;
                number
            })
            .collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (middle, centre) = (mean(&numbers), mean(columns));
        let (mut square, mut product) = (0.0, 0.0);
        for (number, column) in numbers.iter().zip(columns) {
            square += (number - middle) * (number - middle);
            product += (number - middle) * (column - centre);
        }
        let pitch = product / square;
        Self {
            first: centre - pitch * middle,
            pitch,
            count: number as usize + 1,
            shift: LARGEST_SHIFT,
        }
    }

    /// How far a coordinate lies off the nearest column (row), in pitches.
    fn off(&self, value: f64) -> f64 {
        let place = (value - self.first) / self.pitch;
        (place - place.round()).abs()
    }

    /// The number of the column (row) to which a coordinate belongs.
    pub fn place(&self, value: f64) -> Option<usize> {
        let whole = ((value - self.first) / self.pitch).round();
        let near = self.off(value) <= self.shift;
        (near && whole >= 0.0 && whole < self.count as f64).then_some(whole as usize)
    }

    /// The coordinate of the middle.
    pub fn middle(&self) -> f64 {
        self.first + 0.5 * self.pitch * (self.count - 1) as f64
    }
}

/// Each coordinate once, in order. Zero has two signs, and they are one place.
fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut known = HashSet::new();
    let mut all: Vec<f64> = values
        .map(|value| value + 0.0)
        .filter(|value| known.insert(value.to_bits()))
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The middles of the coordinates that are one column.
fn columns(all: &[f64]) -> Vec<f64> {
    let gaps = all
        .iter()
        .skip(1)
        .zip(all)
        .map(|(after, before)| after - before);
    let same = SAME * gaps.fold(0.0, f64::max);
    let columns = all.chunk_by(|before, after| after - before <= same);
    let middle = |column: &[f64]| match column {
        [first, .., last] => 0.5 * (first + last),
        [only] => *only,
        [] => f64::NAN,
    };
    columns.map(middle).collect()
}

fn gaps(columns: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    let pairs = columns.iter().zip(columns.iter().skip(1));
    pairs.map(|(before, after)| (after - before, *after))
}

/// The mean distance of neighbouring columns.
fn neighbours(columns: &[f64]) -> f64 {
    let least = gaps(columns)
        .map(|(gap, _)| gap)
        .fold(f64::INFINITY, f64::min);
    let near = gaps(columns)
        .map(|(gap, _)| gap)
        .filter(|gap| *gap < NEIGHBOURS * least);
    let (sum, count) = near.fold((0.0, 0.0), |(sum, count), gap| (sum + gap, count + 1.0));
    sum / count
}

/// The error for columns whose distances have no common measure.
fn unlike_gaps(columns: &[f64]) -> UnevenAxis {
    let by_gap = |one: &(f64, f64), other: &(f64, f64)| one.0.total_cmp(&other.0);
    let least = gaps(columns).min_by(by_gap).unwrap_or_default();
    let largest = gaps(columns).max_by(by_gap).unwrap_or_default();
    UnevenAxis {
        what: format!(
            "the distances differ: {} and {}",
            Short(least.0),
            Short(largest.0)
        ),
        value: least.1,
    }
}
