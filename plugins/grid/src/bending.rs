//! Holes are filled so that the sheet bends least.
//!
//! The numbers in the holes are those for which the sum of all squares of second differences, along
//! x, along y and mixed, is least. That is a thin plate through the known numbers: it goes on with
//! their slope, and waves along an edge die away from it.
//!
//! The equations are solved by conjugate gradients, from a start that the same sheet at half the
//! resolution gives. It need not be exact: every sheet would do that is smooth to the eye of the
//! tool. All sums run in one order, so the same map gives the same bytes.

use crate::sheet::Sheet;

/// Most steps of the gradients at each resolution. The coarse sheets leave only short waves to the
/// finer ones, and these need few.
const STEPS: usize = 60;

/// Sheets with fewer unknown numbers than this are solved to rounding.
const SMALL: usize = 4096;

/// Most steps for a small sheet.
const STEPS_OF_SMALL: usize = 4 * SMALL;

/// The share of the first residual at which the search ends.
const SMALLEST_RESIDUAL: f64 = 1e-4;

/// The same for a small sheet.
const SMALLEST_RESIDUAL_OF_SMALL: f64 = 1e-12;

/// The shortest side that is halved.
const SHORTEST: usize = 8;

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
    plate.relax(&mut sheet.values, &unknown);
}

/// Fills the unknown numbers from the sheet at half the resolution.
fn begin(sheet: &mut Sheet, unknown: &[usize], ratio: f64) {
    let mut half = Sheet::of(sheet.columns.div_ceil(2), sheet.rows.div_ceil(2), f64::NAN);
    let every_second = sheet.lines().step_by(2);
    for (line, of_half) in every_second.zip(half.values.chunks_exact_mut(half.columns)) {
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

/// The number of a finer sheet, from the two or four around it.
fn between(half: &Sheet, column: usize, row: usize) -> f64 {
    let near = |place: usize, last: usize| [(place / 2).min(last), place.div_ceil(2).min(last)];
    let (columns, rows) = (near(column, half.columns - 1), near(row, half.rows - 1));
    let mut sum = 0.0;
    for row in rows {
        for column in columns {
            sum += half.values[row * half.columns + column];
        }
    }
    0.25 * sum
}

/// The energy of a bent sheet.
struct Plate {
    columns: usize,
    rows: usize,
    /// What the square of a second difference counts: along x, along y, mixed.
    weights: [f64; 3],
}

impl Plate {
    fn new(columns: usize, rows: usize, ratio: f64) -> Self {
        let square = ratio * ratio;
        Self {
            columns,
            rows,
            weights: [1.0 / square, square, 2.0],
        }
    }

    /// Half the derivative of the energy by one number.
    fn force(&self, values: &[f64], place: usize) -> f64 {
        let (row, column) = (place / self.columns, place % self.columns);
        let inner = |at: usize, count: usize| at >= 2 && at + 2 < count;
        if inner(row, self.rows) && inner(column, self.columns) {
            return self.force_inside(values, place);
        }
        let [along_x, along_y, mixed] = self.weights;
        along_x * straight(values, place, 1, column, self.columns)
            + along_y * straight(values, place, self.columns, row, self.rows)
            + mixed * self.twist(values, (column, row))
    }

    #[inline(always)]
    fn force_inside(&self, values: &[f64], place: usize) -> f64 {
        let at = |offset: usize, back: usize| values[place + offset - back];
        let line = self.columns;
        let [along_x, along_y, mixed] = self.weights;
        let middle = values[place];
        let near_x = at(0, 1) + at(1, 0);
        let near_y = at(0, line) + at(line, 0);
        let corners = at(0, line + 1) + at(1, line) + at(line, 1) + at(line + 1, 0);
        along_x * (at(0, 2) + at(2, 0) - 4.0 * near_x + 6.0 * middle)
            + along_y * (at(0, 2 * line) + at(2 * line, 0) - 4.0 * near_y + 6.0 * middle)
            + mixed * (corners - 2.0 * (near_x + near_y) + 4.0 * middle)
    }

    /// The part of the mixed differences: those of the up to four cells around a place.
    fn twist(&self, values: &[f64], (column, row): (usize, usize)) -> f64 {
        let mut sum = 0.0;
        for top in row.saturating_sub(1)..(row + 1).min(self.rows - 1) {
            for left in column.saturating_sub(1)..(column + 1).min(self.columns - 1) {
                let at =
                    |down: usize, right: usize| values[(top + down) * self.columns + left + right];
                let twist = at(0, 0) - at(0, 1) - at(1, 0) + at(1, 1);
                let same = (top == row) == (left == column);
                sum += if same { twist } else { -twist };
            }
        }
        sum
    }

    /// What a number counts in its own force.
    fn stiffness(&self, place: usize) -> f64 {
        let (row, column) = (place / self.columns, place % self.columns);
        let straight = |at: usize, count: usize| {
            let has = |shift: usize, factor: f64| match at >= shift && at + 2 < count + shift {
                true => factor,
                false => 0.0,
            };
            has(2, 1.0) + has(1, 4.0) + has(0, 1.0)
        };
        let cells = |at: usize, count: usize| {
            f64::from(u8::from(at > 0)) + f64::from(u8::from(at + 1 < count))
        };
        let [along_x, along_y, mixed] = self.weights;
        along_x * straight(column, self.columns)
            + along_y * straight(row, self.rows)
            + mixed * cells(column, self.columns) * cells(row, self.rows)
    }

    /// Conjugate gradients on the unknown numbers, each scaled by its stiffness.
    fn relax(&self, values: &mut [f64], unknown: &[usize]) {
        let (steps, share) = match unknown.len() <= SMALL {
            true => (STEPS_OF_SMALL, SMALLEST_RESIDUAL_OF_SMALL),
            false => (STEPS, SMALLEST_RESIDUAL),
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
            force
                .iter()
                .zip(&over)
                .map(|(force, over)| force * force * over)
                .sum()
        };
        let mut now = square(&force);
        let last = now * share * share;
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

/// The part of the second differences along one axis: `step` apart, at number `at` of `count`.
fn straight(values: &[f64], place: usize, step: usize, at: usize, count: usize) -> f64 {
    // The difference whose first number is `shift` before the place.
    let difference = |shift: usize| {
        if at < shift || at + 2 >= count + shift {
            return 0.0;
        }
        let first = place - shift * step;
        values[first] - 2.0 * values[first + step] + values[first + 2 * step]
    };
    difference(0) - 2.0 * difference(1) + difference(2)
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

    /// The energy by its definition.
    fn energy(sheet: &Sheet, ratio: f64) -> f64 {
        let at = |column: usize, row: usize| sheet.values[row * sheet.columns + column];
        let weights = Plate::new(3, 3, ratio).weights;
        let mut sum = 0.0;
        for row in 0..sheet.rows {
            for column in 0..sheet.columns {
                if column + 2 < sheet.columns {
                    let bend = at(column, row) - 2.0 * at(column + 1, row) + at(column + 2, row);
                    sum += weights[0] * bend * bend;
                }
                if row + 2 < sheet.rows {
                    let bend = at(column, row) - 2.0 * at(column, row + 1) + at(column, row + 2);
                    sum += weights[1] * bend * bend;
                }
                if column + 1 < sheet.columns && row + 1 < sheet.rows {
                    let twist = at(column, row) - at(column + 1, row) - at(column, row + 1)
                        + at(column + 1, row + 1);
                    sum += weights[2] * twist * twist;
                }
            }
        }
        sum
    }

    #[test]
    fn forces_and_stiffness_are_derivatives_of_the_energy() {
        let ratio = 1.25;
        let bent = sheet(9, 7, |u, v| (u * 1.3 + v * v * 0.7) % 1.0);
        let plate = Plate::new(9, 7, ratio);
        for place in 0..bent.values.len() {
            let moved = |by: f64| {
                let mut moved = bent.clone();
                moved.values[place] += by;
                energy(&moved, ratio)
            };
            let force = (moved(1.0) - moved(-1.0)) / 4.0;
            assert!(
                (plate.force(&bent.values, place) - force).abs() < 1e-10,
                "{place}"
            );
            let stiffness = (moved(1.0) + moved(-1.0) - 2.0 * moved(0.0)) / 2.0;
            assert!(
                (plate.stiffness(place) - stiffness).abs() < 1e-10,
                "{place}"
            );
        }
    }

    #[test]
    fn a_plane_goes_on_through_holes_and_beyond_its_edge() {
        let plane = |u: f64, v: f64| 2.0 - 0.3 * u + 0.7 * v;
        let whole = sheet(50, 37, plane);
        let mut holed = sheet(50, 37, |u, v| {
            let inside = (u - 20.0).abs() < 12.0 && (v - 18.0).abs() < 11.0;
            let hole = (u - 18.0).abs() < 5.0 && (v - 15.0).abs() < 4.0;
            if inside && !hole {
                plane(u, v)
            } else {
                f64::NAN
            }
        });
        fill(&mut holed, 1.0);
        for (found, wanted) in holed.values.iter().zip(&whole.values) {
            assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
        }
    }

    /// Nothing in a hole can be moved so that the sheet bends less.
    #[test]
    fn a_small_hole_is_filled_with_the_least_energy() {
        let wave = |u: f64, v: f64| (0.2 * u * v) % 3.0;
        let mut holed = sheet(20, 20, wave);
        for row in 6..12 {
            for column in 5..13 {
                holed.values[row * 20 + column] = f64::NAN;
            }
        }
        let ratio = 0.8;
        fill(&mut holed, ratio);
        let plate = Plate::new(20, 20, ratio);
        for row in 6..12 {
            for column in 5..13 {
                let force = plate.force(&holed.values, row * 20 + column);
                assert!(force.abs() < 1e-8, "{force}");
            }
        }
    }
}
