//! Holes are filled, and sheets are carried on, so that the bend changes least.
//!
//! The unknown numbers are those for which the sum of all squares of third differences is least:
//! along x, along y, and mixed. So a sheet goes on with its slope and its curvature, a quadratic goes
//! on as itself, and waves along an edge die away from it.
//!
//! The equations of the [`plate`](crate::plate) are solved from a start that the same sheet at half the
//! resolution gives.

use crate::plate::{Plate, SMALL};
use crate::sheet::Sheet;

/// How far from known numbers a large sheet is solved, in numbers. Farther away the sheet is so smooth
/// that half the resolution has all of it.
const BAND: usize = 24;

/// The shortest side that is halved.
const SHORTEST: usize = 12;

/// Fills all numbers that are NaN. `ratio` is the pitch along x over that along y.
pub fn fill(sheet: &mut Sheet, ratio: f64) {
    let unknown: Vec<usize> = (0..sheet.values.len())
        .filter(|place| sheet.values[*place].is_nan())
        .collect();
    if unknown.is_empty() {
        return;
    }
    if unknown.len() == sheet.values.len() {
        sheet.values.fill(0.0);
        return;
    }
    begin(sheet, &unknown, ratio);
    let plate = Plate::new(sheet.columns, sheet.rows, ratio);
    let near = match unknown.len() <= SMALL {
        true => unknown,
        false => within_band(&unknown, sheet.columns, sheet.rows),
    };
    plate.relax(&mut sheet.values, &near);
}

/// Of some places those that others are near: at most [`BAND`] columns and rows away together.
fn within_band(unknown: &[usize], columns: usize, rows: usize) -> Vec<usize> {
    const FAR: u8 = BAND as u8 + 1;
    let mut apart = vec![0; columns * rows];
    for place in unknown {
        apart[*place] = FAR;
    }
    for line in apart.chunks_exact_mut(columns) {
        count_on(line.iter_mut());
        count_on(line.iter_mut().rev());
    }
    for column in 0..columns {
        let down = || (0..rows).map(move |row| row * columns + column);
        let step = |apart: &mut Vec<u8>, before: u8, place: usize| {
            apart[place] = apart[place].min(before.saturating_add(1));
            apart[place]
        };
        down().fold(FAR, |before, place| step(&mut apart, before, place));
        down()
            .rev()
            .fold(FAR, |before, place| step(&mut apart, before, place));
    }
    let is_near = |place: &usize| apart.get(*place).is_some_and(|apart| *apart < FAR);
    unknown.iter().copied().filter(is_near).collect()
}

/// Makes each number at most one more than the one before.
fn count_on<'a>(numbers: impl Iterator<Item = &'a mut u8>) {
    let mut before = u8::MAX - 1;
    for number in numbers {
        *number = (*number).min(before + 1);
        before = *number;
    }
}

/// Fills the unknown numbers from the sheet at half the resolution.
fn begin(sheet: &mut Sheet, unknown: &[usize], ratio: f64) {
    let mut half = Sheet::of(sheet.columns.div_ceil(2), sheet.rows.div_ceil(2), f64::NAN);
    let every_second = sheet.lines().step_by(2);
    for (line, of_half) in every_second.zip(half.lines_mut()) {
        for (value, place) in line.iter().step_by(2).zip(of_half) {
            *place = *value;
        }
    }
    let is_small = sheet.columns.min(sheet.rows) < SHORTEST;
    if is_small || half.values.iter().all(|value| value.is_nan()) {
        for place in unknown {
            sheet.values[*place] = 0.0;
        }
        return;
    }
    fill(&mut half, ratio);
    for place in unknown {
        let (row, column) = (place / sheet.columns, place % sheet.columns);
        sheet.values[*place] = between(&half, column, row);
    }
}

/// The number of a finer sheet: the cubic through four numbers along each axis.
fn between(half: &Sheet, column: usize, row: usize) -> f64 {
    let (columns, rows) = (around(column, half.columns), around(row, half.rows));
    let mut sum = 0.0;
    for (row, share) in rows {
        for (column, part) in columns {
            sum += share * part * half.values[row * half.columns + column];
        }
    }
    sum
}

/// The four numbers of the coarse sheet around a place of the fine one, with their shares. At an end
/// the line through the last two goes on.
fn around(place: usize, count: usize) -> [(usize, f64); 4] {
    let (before, last) = (place / 2, count - 1);
    if place.is_multiple_of(2) {
        return [(before, 1.0), (before, 0.0), (before, 0.0), (before, 0.0)];
    }
    if before == last {
        let other = before.saturating_sub(1);
        return [(before, 1.5), (other, -0.5), (before, 0.0), (before, 0.0)];
    }
    if before == 0 || before + 1 == last {
        return [
            (before, 0.5),
            (before + 1, 0.5),
            (before, 0.0),
            (before, 0.0),
        ];
    }
    [
        (before - 1, -0.0625),
        (before, 0.5625),
        (before + 1, 0.5625),
        (before + 2, -0.0625),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_goes_on_through_holes_and_beyond_its_edge() {
        let quadratic = |u: f64, v: f64| 2.0 - 0.3 * u + 0.7 * v + 0.01 * u * u - 0.02 * u * v;
        let whole = Sheet::of_values(50, 37, quadratic);
        let mut holed = Sheet::of_values(50, 37, |u, v| {
            let inside = (u - 20.0).abs() < 14.0 && (v - 18.0).abs() < 13.0;
            let hole = (u - 18.0).abs() < 5.0 && (v - 15.0).abs() < 4.0;
            if inside && !hole {
                quadratic(u, v)
            } else {
                f64::NAN
            }
        });
        fill(&mut holed, 1.0);
        for (found, wanted) in holed.values.iter().zip(&whole.values) {
            // The search ends after so many steps: at a ten-thousandth of the height, which is 40.
            assert!((found - wanted).abs() < 4e-3, "{found} {wanted}");
        }
    }

    #[test]
    fn a_band_has_all_places_that_are_not_too_far_away() {
        let (columns, rows) = (90, 70);
        let known = |place: usize| (place % columns == 3 && place / columns < 9) || place == 2000;
        let unknown: Vec<usize> = (0..columns * rows).filter(|place| !known(*place)).collect();
        let near = within_band(&unknown, columns, rows);
        let apart = |one: usize, other: usize| {
            let across = (one % columns).abs_diff(other % columns);
            across + (one / columns).abs_diff(other / columns)
        };
        let all: Vec<usize> = (0..columns * rows).filter(|place| known(*place)).collect();
        for place in unknown {
            let least = all.iter().map(|known| apart(*known, place)).min().unwrap();
            assert_eq!(near.contains(&place), least <= BAND, "{place}");
        }
    }

    /// Nothing in a hole can be moved so that the sum is less.
    #[test]
    fn a_small_hole_is_filled_with_the_least_sum() {
        let mut holed = Sheet::of_values(20, 20, |u, v| (0.2 * u * v) % 3.0);
        let hole = || (6..12).flat_map(|row| (5..13).map(move |column| row * 20 + column));
        for place in hole() {
            holed.values[place] = f64::NAN;
        }
        let ratio = 0.8;
        fill(&mut holed, ratio);
        let plate = Plate::new(20, 20, ratio);
        let hole: Vec<usize> = hole().collect();
        for (place, force) in hole.iter().zip(plate.forces_of(&holed.values, &hole)) {
            assert!(
                force.abs() < 1e-4 * plate.differences.stiffness(*place),
                "{force}"
            );
        }
    }
}
