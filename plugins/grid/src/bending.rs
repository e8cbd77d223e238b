//! Holes are filled, and sheets are carried on, so that the bend changes least.
//!
//! The unknown numbers are those for which the sum of all squares of third differences is least:
//! along x, along y, and mixed. So a sheet goes on with its slope and its curvature, a quadratic goes
//! on as itself, and waves along an edge die away from it.
//!
//! The equations are solved by conjugate gradients, from a start that the same sheet at half the
//! resolution gives. The solution need not be exact: what counts is that the sheet is smooth. All
//! sums run in one order, so the same map gives the same bytes.

use crate::sheet::Sheet;

/// Most steps of the gradients at each resolution. The coarse sheets leave only short waves to the
/// finer ones, and these need few.
const STEPS: usize = 60;

/// Sheets with no more unknown numbers than this take more steps.
const SMALL: usize = 2048;

/// Most steps for a small sheet.
const STEPS_OF_SMALL: usize = 2000;

/// How far from known numbers a large sheet is solved, in numbers. Farther away the sheet is so smooth
/// that half the resolution has all of it.
const BAND: usize = 24;

/// The share of the first residual at which the search ends.
const SMALLEST_RESIDUAL: f64 = 1e-9;

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

/// Numbers on the side of the largest difference.
const SIDE: usize = 4;

/// How far a number reaches in the sum of squares.
const REACH: usize = SIDE - 1;

/// A kind of third differences.
#[derive(Debug, Clone)]
struct Difference {
    /// Factors along x and along y; the difference is the sum over all products.
    along: [Vec<f64>; 2],
    /// What its square counts.
    weight: f64,
}

/// The sum of squares of third differences over a sheet.
struct Plate {
    columns: usize,
    rows: usize,
    differences: [Difference; 4],
    /// Where all differences lie within the sheet: what each neighbour counts in a force, by rows.
    inside: [[f64; 2 * REACH + 1]; 2 * REACH + 1],
}

impl Plate {
    fn new(columns: usize, rows: usize, ratio: f64) -> Self {
        let factors = |order: usize| match order {
            0 => vec![1.0],
            1 => vec![-1.0, 1.0],
            2 => vec![1.0, -2.0, 1.0],
            _ => vec![-1.0, 3.0, -3.0, 1.0],
        };
        // Differences along x are those over longer steps, if the pitch along x is the larger one.
        let differences = [3, 2, 1, 0].map(|order: usize| Difference {
            along: [factors(order), factors(3 - order)],
            weight: [1.0, 3.0, 3.0, 1.0][order] * (0..order).fold(1.0, |w, _| w / (ratio * ratio)),
        });
        let mut inside = [[0.0; 2 * REACH + 1]; 2 * REACH + 1];
        for difference in &differences {
            let [of_x, of_y] = difference.along.each_ref().map(|along| squared(along));
            for (line, y) in inside.iter_mut().zip(of_y) {
                for (factor, x) in line.iter_mut().zip(of_x) {
                    *factor += difference.weight * x * y;
                }
            }
        }
        Self {
            columns,
            rows,
            differences,
            inside,
        }
    }

    /// Half the derivative of the sum by one number.
    fn force(&self, values: &[f64], place: usize) -> f64 {
        let (row, column) = (place / self.columns, place % self.columns);
        let inner = |at: usize, count: usize| at >= REACH && at + REACH < count;
        if inner(row, self.rows) && inner(column, self.columns) {
            let corner = place - REACH * (self.columns + 1);
            return self.force_inside(values, corner);
        }
        let differences = self.differences.iter();
        differences
            .map(|one| one.weight * self.at_edge(one, values, (column, row)))
            .sum()
    }

    #[inline(always)]
    fn force_inside(&self, values: &[f64], corner: usize) -> f64 {
        let mut force = 0.0;
        for (number, factors) in self.inside.iter().enumerate() {
            let line = &values[corner + number * self.columns..][..2 * REACH + 1];
            // Towards the corners the factors are zero.
            let skip = number.abs_diff(REACH);
            let used = skip..2 * REACH + 1 - skip;
            for (factor, value) in factors[used.clone()].iter().zip(&line[used]) {
                force += factor * value;
            }
        }
        force
    }

    /// The part of one kind of differences: of all those within the sheet that contain the number.
    fn at_edge(&self, one: &Difference, values: &[f64], (column, row): (usize, usize)) -> f64 {
        let [of_x, of_y] = &one.along;
        let mut sum = 0.0;
        for (down, factor_y) in starts(row, self.rows, of_y) {
            for (right, factor_x) in starts(column, self.columns, of_x) {
                let mut difference = 0.0;
                for (y, row) in of_y.iter().zip(down..) {
                    let line = &values[row * self.columns + right..];
                    for (x, value) in of_x.iter().zip(line) {
                        difference += x * y * value;
                    }
                }
                sum += factor_x * factor_y * difference;
            }
        }
        sum
    }

    /// What a number counts in its own force.
    fn stiffness(&self, place: usize) -> f64 {
        let (row, column) = (place / self.columns, place % self.columns);
        let squares = |at: usize, count: usize, along: &[f64]| -> f64 {
            starts(at, count, along)
                .map(|(_, factor)| factor * factor)
                .sum()
        };
        let of = |one: &Difference| {
            let [of_x, of_y] = &one.along;
            one.weight * squares(column, self.columns, of_x) * squares(row, self.rows, of_y)
        };
        self.differences.iter().map(of).sum()
    }

    /// Conjugate gradients on the unknown numbers, each scaled by its stiffness.
    fn relax(&self, values: &mut [f64], unknown: &[usize]) {
        let steps = match unknown.len() <= SMALL {
            true => STEPS_OF_SMALL,
            false => STEPS,
        };
        let mut force: Vec<f64> = unknown
            .iter()
            .map(|place| -self.force(values, *place))
            .collect();
        let over: Vec<f64> = unknown
            .iter()
            .map(|place| 1.0 / self.stiffness(*place))
            .collect();
        let mut direction = vec![0.0; values.len()];
        let mut answer = vec![0.0; unknown.len()];
        let square = |force: &[f64]| -> f64 {
            let terms = force.iter().zip(&over);
            terms.map(|(force, over)| force * force * over).sum()
        };
        let mut now = square(&force);
        let last = now * SMALLEST_RESIDUAL * SMALLEST_RESIDUAL;
        for ((place, force), over) in unknown.iter().zip(&force).zip(&over) {
            direction[*place] = force * over;
        }
        for _ in 0..steps {
            if now <= last || now == 0.0 {
                return;
            }
            let mut work = 0.0;
            for (place, answer) in unknown.iter().zip(&mut answer) {
                *answer = self.force(&direction, *place);
                work += direction[*place] * *answer;
            }
            if work <= 0.0 {
                return;
            }
            let step = now / work;
            for ((place, force), answer) in unknown.iter().zip(&mut force).zip(&answer) {
                values[*place] += step * direction[*place];
                *force -= step * answer;
            }
            let before = now;
            now = square(&force);
            let kept = now / before;
            for ((place, force), over) in unknown.iter().zip(&force).zip(&over) {
                direction[*place] = force * over + kept * direction[*place];
            }
        }
    }
}

/// The factors of neighbours, from the farthest one before on, in the derivative of a square.
fn squared(along: &[f64]) -> [f64; 2 * REACH + 1] {
    let mut factors = [0.0; 2 * REACH + 1];
    for (i, one) in along.iter().enumerate() {
        for (j, other) in along.iter().enumerate() {
            factors[REACH + j - i] += one * other;
        }
    }
    factors
}

/// Where the differences begin that lie within the sheet and contain a number, and the number's
/// factor in each.
fn starts(at: usize, count: usize, along: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    let starts = along
        .iter()
        .enumerate()
        .filter_map(move |(number, factor)| {
            let start = at.checked_sub(number)?;
            Some((start, *factor))
        });
    let length = along.len();
    starts.filter(move |(start, _)| start + length <= count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Sheet {
        let mut sheet = Sheet::of(columns, rows, 0.0);
        for (row, line) in sheet.lines_mut().enumerate() {
            for (column, place) in line.iter_mut().enumerate() {
                *place = value(column as f64, row as f64);
            }
        }
        sheet
    }

    /// The sum of squares by its definition: first differences, three times.
    fn energy(sheet: &Sheet, ratio: f64) -> f64 {
        let along_x = |sheet: &Sheet| {
            let mut less = Sheet::of(sheet.columns - 1, sheet.rows, 0.0);
            for (line, of_less) in sheet.lines().zip(less.lines_mut()) {
                for (pair, place) in line.windows(2).zip(of_less) {
                    *place = (pair[1] - pair[0]) / ratio;
                }
            }
            less
        };
        let along_y = |sheet: &Sheet| {
            let mut less = Sheet::of(sheet.columns, sheet.rows - 1, 0.0);
            for (place, difference) in less.values.iter_mut().enumerate() {
                *difference = sheet.values[place + sheet.columns] - sheet.values[place];
            }
            less
        };
        let squares = |sheet: Sheet| -> f64 { sheet.values.iter().map(|v| v * v).sum() };
        squares(along_x(&along_x(&along_x(sheet))))
            + 3.0 * squares(along_x(&along_x(&along_y(sheet))))
            + 3.0 * squares(along_x(&along_y(&along_y(sheet))))
            + squares(along_y(&along_y(&along_y(sheet))))
    }

    #[test]
    fn forces_and_stiffness_are_derivatives_of_the_sum() {
        let ratio = 1.25;
        let bent = sheet(9, 8, |u, v| (u * 1.3 + v * v * 0.7) % 1.0);
        let plate = Plate::new(9, 8, ratio);
        for place in 0..bent.values.len() {
            let moved = |by: f64| {
                let mut moved = bent.clone();
                moved.values[place] += by;
                energy(&moved, ratio)
            };
            let force = (moved(1.0) - moved(-1.0)) / 4.0;
            let found = plate.force(&bent.values, place);
            assert!((found - force).abs() < 1e-9, "{place}: {found} {force}");
            let stiffness = (moved(1.0) + moved(-1.0) - 2.0 * moved(0.0)) / 2.0;
            let found = plate.stiffness(place);
            assert!(
                (found - stiffness).abs() < 1e-9,
                "{place}: {found} {stiffness}"
            );
        }
    }

    #[test]
    fn a_quadratic_goes_on_through_holes_and_beyond_its_edge() {
        let quadratic = |u: f64, v: f64| 2.0 - 0.3 * u + 0.7 * v + 0.01 * u * u - 0.02 * u * v;
        let whole = sheet(50, 37, quadratic);
        let mut holed = sheet(50, 37, |u, v| {
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
        let mut holed = sheet(20, 20, |u, v| (0.2 * u * v) % 3.0);
        let hole = || (6..12).flat_map(|row| (5..13).map(move |column| row * 20 + column));
        for place in hole() {
            holed.values[place] = f64::NAN;
        }
        let ratio = 0.8;
        fill(&mut holed, ratio);
        let plate = Plate::new(20, 20, ratio);
        for place in hole() {
            let force = plate.force(&holed.values, place);
            assert!(force.abs() < 1e-4 * plate.stiffness(place), "{force}");
        }
    }
}
