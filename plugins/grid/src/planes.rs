//! Planes of best fit through neighbours, weighted, for places that lie side by side.

use std::collections::VecDeque;

use turnpath_plugin::registers::{Loop, in_widest};

use crate::blocks::Blocks;
use crate::gaussian::Gaussian;

/// The share of the full determinant below which neighbours lie on a line, and give a mean alone.
const FLAT: f64 = 1e-9;

/// Places in a row whose planes are fitted together.
pub const PLACES: usize = 8;

/// A number of each place.
type Numbers = [f64; PLACES];

/// The planes through the means of blocks.
pub struct Planes<'a> {
    blocks: &'a Blocks,
    along_x: &'a Gaussian,
    along_y: &'a Gaussian,
    /// The row of the first line.
    top: usize,
    /// The rows of blocks that count at the places that were looked at last.
    lines: VecDeque<Line>,
}

/// A row of blocks, longer on both sides by what may be looked at around a place. Blocks that are holes, or that
/// are not there, have no share.
struct Line {
    /// The share of each block's points that have a number.
    share: Vec<f64>,
    /// Where the middle of each block's numbers lies, from the block's own middle on.
    x: Vec<f64>,
    /// The same along y.
    y: Vec<f64>,
    /// The mean of each block.
    value: Vec<f64>,
}

impl Line {
    fn of(blocks: &Blocks, row: usize, reach: usize) -> Self {
        let means = &blocks.means;
        let width = means.columns + 2 * reach + PLACES;
        let [mut share, mut x, mut y, mut value] = [(); 4].map(|()| vec![0.0; width]);
        for column in 0..means.columns {
            let (place, at) = (row * means.columns + column, reach + column);
            if !means.values[place].is_nan() {
                let middle = blocks.middle(place);
                (share[at], x[at], y[at]) = (middle.share, middle.x, middle.y);
                value[at] = means.values[place];
            }
        }
        Self { share, x, y, value }
    }
}

impl<'a> Planes<'a> {
    /// Planes whose neighbours count with these weights along x and along y.
    pub fn new(blocks: &'a Blocks, along_x: &'a Gaussian, along_y: &'a Gaussian) -> Self {
        Self {
            blocks,
            along_x,
            along_y,
            top: 0,
            lines: VecDeque::new(),
        }
    }

    /// The heights, at a place and at those behind it in its row, of the planes that fit their neighbours best.
    /// It takes least time to go from row to row downwards.
    pub fn heights(&mut self, column: usize, row: usize) -> Numbers {
        self.move_to(row);
        in_widest(Fit {
            planes: self,
            column,
            row,
        })
    }

    /// Takes up the lines that count at a row, and drops the others.
    fn move_to(&mut self, row: usize) {
        let top = row.saturating_sub(self.along_y.reach);
        let end = (row + self.along_y.reach + 1).min(self.blocks.means.rows);
        if (self.top..=self.top + self.lines.len()).contains(&top) {
            self.lines.drain(..top - self.top);
        } else {
            self.lines.clear();
        }
        self.top = top;
        self.lines.truncate(end - top);
        for row in top + self.lines.len()..end {
            let line = Line::of(self.blocks, row, self.along_x.reach);
            self.lines.push_back(line);
        }
    }
}

/// The loop that fits planes around places.
struct Fit<'a> {
    planes: &'a Planes<'a>,
    column: usize,
    row: usize,
}

impl<'a> Loop for Fit<'a> {
    type Output = Numbers;

    #[inline(always)]
    fn call(self) -> Numbers {
        let Self {
            planes,
            column,
            row,
        } = self;
        let (along_x, along_y) = (planes.along_x, planes.along_y);
        let around = column..column + PLACES + 2 * along_x.reach;
        let rows = planes.top..;
        // Weights, and weights times x, y, x², xy, y²; then heights, and heights times x, y.
        let (mut w, mut h) = ([[0.0; PLACES]; 6], [[0.0; PLACES]; 3]);
        for (other, line) in rows.zip(&planes.lines) {
            let (of_row, down) = (along_y.at(row, other), other as f64 - row as f64);
            let around = |numbers: &'a [f64]| numbers[around.clone()].windows(PLACES);
            let places = around(&line.share).zip(around(&line.x));
            let heights = around(&line.y).zip(around(&line.value));
            for (step, ((share, x), (y, value))) in places.zip(heights).enumerate() {
                let of_column = along_x.at(along_x.reach, step);
                let right = step as f64 - along_x.reach as f64;
                for i in 0..PLACES {
                    let (x, y) = (right + x[i], down + y[i]);
                    let weight = share[i] * of_row * of_column;
                    for (sum, term) in w.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                        sum[i] += weight * term;
                    }
                    for (sum, term) in h.iter_mut().zip([1.0, x, y]) {
                        sum[i] += weight * term * value[i];
                    }
                }
            }
        }
        std::array::from_fn(|i| height(w.map(|w| w[i]), h.map(|h| h[i])))
    }
}

/// The height of the plane, from the sums of weights and of heights.
#[inline(always)]
fn height([one, x, y, xx, xy, yy]: [f64; 6], h: [f64; 3]) -> f64 {
    // Minors of the matrix of the three equations, along its first row.
    let minors = [xx * yy - xy * xy, x * yy - xy * y, x * xy - xx * y];
    let determinant = one * minors[0] - x * minors[1] + y * minors[2];
    if determinant > FLAT * one * xx * yy {
        return (h[0] * minors[0] - h[1] * minors[1] + h[2] * minors[2]) / determinant;
    }
    h[0] / one
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Sheet;

    /// The same from one block after the other, at one place.
    fn alone(blocks: &Blocks, [along_x, along_y]: [&Gaussian; 2], at: (usize, usize)) -> f64 {
        let (column, row) = at;
        let (mut w, mut h) = ([0.0; 6], [0.0; 3]);
        let sheet = &blocks.means;
        for (place, value) in sheet.values.iter().enumerate() {
            let (right, down) = (place % sheet.columns, place / sheet.columns);
            let middle = blocks.middle(place);
            let (x, y) = (
                right as f64 - column as f64 + middle.x,
                down as f64 - row as f64 + middle.y,
            );
            let weight = middle.share * along_y.at(row, down) * along_x.at(column, right);
            if value.is_nan() || weight == 0.0 {
                continue;
            }
            for (sum, term) in w.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                *sum += weight * term;
            }
            for (sum, term) in h.iter_mut().zip([1.0, x, y]) {
                *sum += weight * term * value;
            }
        }
        height(w, h)
    }

    /// At all edges and beside holes, with blocks of single points and of several, some of which are missing.
    #[test]
    fn heights_side_by_side_are_those_of_each_place_alone() {
        let jump = |u: f64, v: f64| (3.7 * u * u + 5.3 * v + 2.9 * u * v) % 4.0;
        let is_there = |u: f64, v: f64| (u * 37.0 + v * 101.0 + u * v * 13.0) % 64.0 > 19.0;
        let sheet = Sheet::of_values(42, 22, |u, v| match is_there(u, v) {
            true => jump(u, v),
            false => f64::NAN,
        });
        for (wide, high) in [(1, 1), (2, 1), (3, 2)] {
            let blocks = Blocks::of(&sheet, wide, high);
            let [along_x, along_y] = [4.2, 3.0].map(Gaussian::new);
            let mut planes = Planes::new(&blocks, &along_x, &along_y);
            let Sheet { columns, rows, .. } = blocks.means;
            // Downwards, and then from anywhere to anywhere.
            for row in (0..rows).chain([3, 3, rows - 1, 0, rows / 2, 1]) {
                for column in 0..columns {
                    let together = planes.heights(column, row);
                    for (found, column) in together.iter().zip(column..columns) {
                        let wanted = alone(&blocks, [&along_x, &along_y], (column, row));
                        assert_eq!(found.to_bits(), wanted.to_bits(), "{column} {row}");
                    }
                }
            }
        }
    }
}
