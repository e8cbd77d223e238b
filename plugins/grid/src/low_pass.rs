//! The low-pass for measured maps: a Gaussian filter, as ISO 16610-61 has it for areas.
//!
//! A wave as long as the cutoff keeps half of its height; one of half that length keeps a sixteenth.
//! Each number becomes that of the plane that fits its neighbours best, weighted by the Gaussian: at
//! edges and beside holes this follows a slope, where a mean would not. Holes count nothing and stay
//! holes.
//!
//! A map that is much finer than the cutoff is averaged in [`Blocks`] first. Each block weighs as many
//! times as it has numbers, and stands where their middle lies: so no number is lost where a map has
//! many holes.

use crate::blocks::Blocks;
use crate::gaussian::Gaussian;
use crate::planes::{PLACES, Planes};
use crate::sheet::Sheet;

/// Filters the means of blocks. `cutoff` is in columns and in rows of blocks.
pub fn filter(blocks: &Blocks, cutoff: [f64; 2]) -> Sheet {
    let [along_x, along_y] = cutoff.map(Gaussian::new);
    let sheet = &blocks.means;
    let full = Full::of(blocks);
    let mut filtered = spread(sheet, &along_x, &along_y);
    let mut planes = Planes::new(blocks, &along_x, &along_y);
    let lines = filtered.lines_mut().zip(sheet.lines());
    for (row, (line, means)) in lines.enumerate() {
        let mut known = 0..0;
        let mut heights = [0.0; PLACES];
        for (column, (value, mean)) in line.iter_mut().zip(means).enumerate() {
            if mean.is_nan() {
                *value = f64::NAN;
            } else if !full.around(column, row, along_x.reach, along_y.reach) {
                if !known.contains(&column) {
                    known = column..column + PLACES;
                    heights = planes.heights(column, row);
                }
                *value = heights[column - known.start];
            }
        }
    }
    filtered
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

/// Sums of whole blocks, from the corner on.
struct Full {
    columns: usize,
    rows: usize,
    sums: Vec<u32>,
}

impl Full {
    fn of(blocks: &Blocks) -> Self {
        let sheet = &blocks.means;
        let wide = sheet.columns + 1;
        let mut sums = vec![0_u32; wide * (sheet.rows + 1)];
        for (row, line) in sheet.lines().enumerate() {
            let mut of_row = 0;
            for column in 0..line.len() {
                of_row += u32::from(blocks.is_whole(row * sheet.columns + column));
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

    /// Whether all blocks are whole that are not farther away.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{LN_2, TAU};

    use turnpath_plugin::prelude::Scalar;

    /// ISO 16610-61: half of a wave as long as the cutoff passes, and exp(−ln 2 (λc/λ)²) of others.
    #[test]
    fn a_wave_as_long_as_the_cutoff_keeps_half_of_its_height() {
        let (cutoff_x, cutoff_y) = (10.0, 7.0);
        for length in [5.0, 10.0, 20.0, 40.0] {
            let wave = Sheet::of_values(121, 60, |u, _| Scalar::cos(TAU * (u - 60.0) / length));
            let filtered = filter(&Blocks::of(&wave, 1, 1), [cutoff_x, cutoff_y]);
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
        let holed = Sheet::of_values(
            40,
            30,
            |u, v| if hole(u, v) { f64::NAN } else { plane(u, v) },
        );
        let filtered = filter(&Blocks::of(&holed, 1, 1), [6.0, 4.5]);
        for (place, (found, given)) in filtered.values.iter().zip(&holed.values).enumerate() {
            assert_eq!(found.is_nan(), given.is_nan());
            let far = (found - given).abs() > 1e-11;
            assert!(!far, "{place}: {found} {given}");
        }
    }

    /// Nine points in 64 have a number, and blocks of 4 × 3 points have few or none.
    #[test]
    fn a_plane_stays_where_a_block_has_few_numbers() {
        let is_there =
            |u: f64, v: f64| (u * 37.0 + v * 101.0 + u * v * 13.0).rem_euclid(64.0) < 9.0;
        let plane = |u: f64, v: f64| 1.0 + 0.3 * u - 0.2 * v;
        let sparse = Sheet::of_values(160, 120, |u, v| match is_there(u, v) {
            true => plane(u, v),
            false => f64::NAN,
        });
        let blocks = Blocks::of(&sparse, 4, 3);
        let filtered = filter(&blocks, [12.0, 14.0]);
        let mut found = 0;
        for (place, value) in filtered.values.iter().enumerate() {
            let (column, row) = ((place % 40) as f64, (place / 40) as f64);
            let wanted = plane(4.0 * column + 1.5, 3.0 * row + 1.0);
            assert!(
                value.is_nan() || (value - wanted).abs() < 1e-11,
                "{value} {wanted}"
            );
            found += usize::from(!value.is_nan());
        }
        assert!((600..1600).contains(&found), "{found}");
    }
}
