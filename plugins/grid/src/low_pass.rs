//! The low-pass for measured maps: a Gaussian filter, as ISO 16610-61 has it for areas.
//!
//! A wave as long as the cutoff keeps half of its height; one of half that length keeps a sixteenth.
//! Each number becomes that of the plane that fits its neighbours best, weighted by the Gaussian: at
//! edges and beside holes this follows a slope, where a mean would not. Holes count nothing and stay
//! holes.
//!
//! A map that is much finer than the cutoff is averaged in blocks first.

use std::f64::consts::{LN_2, PI};

use turnpath_plugin::prelude::Scalar;

use crate::sheet::Sheet;

/// Blocks in a cutoff, at least. More take more time. Fewer would let the blocks themselves filter:
/// with 12 of them a wave as long as the cutoff loses one hundredth by the mean over a block.
const BLOCKS: f64 = 12.0;

/// The Gaussian ends at this distance, in cutoffs, where its weight is 6.5e-7.
const END: f64 = 1.0;

/// The share of the full determinant below which neighbours lie on a line, and give a mean alone.
const FLAT: f64 = 1e-9;

/// How many points of a map along one axis go into a block.
pub fn block(cutoff: f64, pitch: f64) -> usize {
    ((cutoff / pitch / BLOCKS) as usize).max(1)
}

/// The means of blocks of `wide` × `high` numbers. What remains at the edges is left out on both
/// sides alike. A block with fewer than half of its numbers is a hole.
pub fn in_blocks(sheet: &Sheet, wide: usize, high: usize) -> Sheet {
    let (columns, rows) = (sheet.columns / wide, sheet.rows / high);
    let (left, top) = ((sheet.columns % wide) / 2, (sheet.rows % high) / 2);
    let mut means = Sheet::of(columns, rows, 0.0);
    let mut counts = vec![0_usize; columns * rows];
    let lines = sheet.lines().skip(top).take(rows * high).enumerate();
    for (number, line) in lines {
        let first = number / high * columns;
        let blocks = line[left..].chunks_exact(wide).zip(first..);
        for (block, place) in blocks.take(columns) {
            for value in block.iter().filter(|value| !value.is_nan()) {
                means.values[place] += value;
                counts[place] += 1;
            }
        }
    }
    for (mean, count) in means.values.iter_mut().zip(counts) {
        *mean = match 2 * count >= wide * high {
            true => *mean / count as f64,
            false => f64::NAN,
        };
    }
    means
}

/// Filters a sheet. `cutoff` is in columns and in rows.
pub fn filter(sheet: &Sheet, cutoff: [f64; 2]) -> Sheet {
    let [along_x, along_y] = cutoff.map(Gaussian::new);
    let full = Full::of(sheet);
    let mut filtered = spread(sheet, &along_x, &along_y);
    for (place, value) in filtered.values.iter_mut().enumerate() {
        let (column, row) = (place % sheet.columns, place / sheet.columns);
        if sheet.values[place].is_nan() {
            *value = f64::NAN;
        } else if !full.around(column, row, along_x.reach, along_y.reach) {
            *value = of_plane(sheet, (column, row), &along_x, &along_y);
        }
    }
    filtered
}

/// Weights along one axis.
struct Gaussian {
    /// From the middle on; the sum over both sides is 1.
    weights: Vec<f64>,
    reach: usize,
}

impl Gaussian {
    fn new(cutoff: f64) -> Self {
        let reach = (cutoff * END).ceil() as usize;
        let weight = |k: usize| {
            let share = k as f64 / cutoff;
            Scalar::exp(-share * share * (PI * PI / LN_2))
        };
        let mut weights: Vec<f64> = (0..=reach).map(weight).collect();
        let sum: f64 = weights.iter().skip(1).sum::<f64>() * 2.0 + 1.0;
        for weight in &mut weights {
            *weight /= sum;
        }
        Self { weights, reach }
    }

    /// The weight of a number `apart` from the middle.
    fn at(&self, one: usize, other: usize) -> f64 {
        self.weights
            .get(one.abs_diff(other))
            .copied()
            .unwrap_or(0.0)
    }
}

/// The weighted means, right where the whole Gaussian lies on numbers: holes count as 0 here.
fn spread(sheet: &Sheet, along_x: &Gaussian, along_y: &Gaussian) -> Sheet {
    let mut solid = sheet.clone();
    for value in &mut solid.values {
        if value.is_nan() {
            *value = 0.0;
        }
    }
    let down = spread_down(&solid, along_y);
    spread_down(&down.transposed(), along_x).transposed()
}

fn spread_down(sheet: &Sheet, along: &Gaussian) -> Sheet {
    let mut sums = Sheet::of(sheet.columns, sheet.rows, 0.0);
    for (row, sum) in sums.lines_mut().enumerate() {
        let first = row.saturating_sub(along.reach);
        let lines = sheet
            .lines()
            .enumerate()
            .skip(first)
            .take(row + along.reach + 1 - first);
        for (other, line) in lines {
            let weight = along.at(row, other);
            for (sum, value) in sum.iter_mut().zip(line) {
                *sum += weight * value;
            }
        }
    }
    sums
}

/// Sums of numbers that are there, from the corner on.
struct Full {
    columns: usize,
    rows: usize,
    sums: Vec<u32>,
}

impl Full {
    fn of(sheet: &Sheet) -> Self {
        let wide = sheet.columns + 1;
        let mut sums = vec![0_u32; wide * (sheet.rows + 1)];
        for (row, line) in sheet.lines().enumerate() {
            let mut of_row = 0;
            for (column, value) in line.iter().enumerate() {
                of_row += u32::from(!value.is_nan());
                let above = sums[row * wide + column + 1];
                sums[(row + 1) * wide + column + 1] = above + of_row;
            }
        }
        Self {
            columns: sheet.columns,
            rows: sheet.rows,
            sums,
        }
    }

    /// Whether all numbers are there that are not farther away.
    fn around(&self, column: usize, row: usize, far_x: usize, far_y: usize) -> bool {
        let inside = |at: usize, far: usize, count: usize| at >= far && at + far < count;
        if !inside(column, far_x, self.columns) || !inside(row, far_y, self.rows) {
            return false;
        }
        let at = |row: usize, column: usize| self.sums[row * (self.columns + 1) + column];
        let (left, right) = (column - far_x, column + far_x + 1);
        let (top, bottom) = (row - far_y, row + far_y + 1);
        let count = at(bottom, right) + at(top, left) - at(top, right) - at(bottom, left);
        count as usize == (right - left) * (bottom - top)
    }
}

/// The height, at a place, of the plane that fits its neighbours best.
fn of_plane(
    sheet: &Sheet,
    (column, row): (usize, usize),
    along_x: &Gaussian,
    along_y: &Gaussian,
) -> f64 {
    // Weights, and weights times x, y, x², xy, y²; then heights, and heights times x, y.
    let (mut w, mut h) = ([0.0; 6], [0.0; 3]);
    let first = |at: usize, reach: usize| at.saturating_sub(reach);
    let (top, left) = (first(row, along_y.reach), first(column, along_x.reach));
    let lines = sheet.lines().enumerate().skip(top);
    for (other, line) in lines.take(row + along_y.reach + 1 - top) {
        let (y, of_row) = (other as f64 - row as f64, along_y.at(row, other));
        let values = line.iter().enumerate().skip(left);
        for (place, value) in values.take(column + along_x.reach + 1 - left) {
            if value.is_nan() {
                continue;
            }
            let (x, weight) = (
                place as f64 - column as f64,
                of_row * along_x.at(column, place),
            );
            for (sum, term) in w.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                *sum += weight * term;
            }
            for (sum, term) in h.iter_mut().zip([1.0, x, y]) {
                *sum += weight * term * value;
            }
        }
    }
    let [one, x, y, xx, xy, yy] = w;
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
    use std::f64::consts::TAU;

    fn sheet(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Sheet {
        let mut sheet = Sheet::of(columns, rows, 0.0);
        for (row, line) in sheet.lines_mut().enumerate() {
            for (column, place) in line.iter_mut().enumerate() {
                *place = value(column as f64, row as f64);
            }
        }
        sheet
    }

    /// ISO 16610-61: half of a wave as long as the cutoff passes, and exp(−ln 2 (λc/λ)²) of others.
    #[test]
    fn a_wave_as_long_as_the_cutoff_keeps_half_of_its_height() {
        let (cutoff_x, cutoff_y) = (10.0, 7.0);
        for length in [5.0, 10.0, 20.0, 40.0] {
            let wave = sheet(121, 60, |u, _| Scalar::cos(TAU * (u - 60.0) / length));
            let filtered = filter(&wave, [cutoff_x, cutoff_y]);
            let share: f64 = cutoff_x / length;
            let wanted = Scalar::exp(-LN_2 * share * share);
            let found = filtered.values[30 * 121 + 60];
            assert!((found - wanted).abs() < 1e-5, "{length}: {found} {wanted}");
        }
    }

    #[test]
    fn a_plane_stays_at_edges_and_beside_holes() {
        let hole = |u: f64, v: f64| (u - 15.0).abs() < 3.0 && (v - 9.0).abs() < 5.0;
        let plane = |u: f64, v: f64| 1.0 + 0.3 * u - 0.2 * v;
        let holed = sheet(
            40,
            30,
            |u, v| if hole(u, v) { f64::NAN } else { plane(u, v) },
        );
        let filtered = filter(&holed, [6.0, 4.5]);
        for (place, (found, given)) in filtered.values.iter().zip(&holed.values).enumerate() {
            assert_eq!(found.is_nan(), given.is_nan());
            let far = (found - given).abs() > 1e-11;
            assert!(!far, "{place}: {found} {given}");
        }
    }

    #[test]
    fn blocks_have_the_means_and_lie_in_the_middle() {
        let mut fine = sheet(11, 7, |u, v| u + 10.0 * v);
        // Columns 1 to 3 and rows 0 to 1 make the first block.
        for place in [1, 2, 3, 12] {
            fine.values[place] = f64::NAN;
        }
        fine.values[4] = f64::NAN;
        let means = in_blocks(&fine, 3, 2);
        assert_eq!((means.columns, means.rows), (3, 3));
        assert!(means.values[0].is_nan());
        // 5, 6, 14, 15, 16 of 4, 5, 6, 14, 15, 16.
        assert!((means.values[1] - 56.0 / 5.0).abs() < 1e-12);
        assert!((means.values[3] - 27.0).abs() < 1e-12);
        assert_eq!((block(1.0, 0.1), block(2.5, 0.1)), (1, 2));
    }
}
