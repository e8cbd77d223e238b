//! Coefficients beyond a spline's own: the quadratic of best fit, plus the straight line through what the two
//! outermost coefficients differ from it by.

use crate::sheet::Sheet;
use crate::trend::Trend;

/// How the coefficients of a sheet go on beyond it.
#[derive(Debug, Clone)]
pub struct Continuation {
    trend: Trend,
    columns: usize,
    rows: usize,
    /// What the coefficients of the outermost columns differ from the trend by, from the first row on.
    at_columns: [Edge; 2],
    /// The same for the outermost rows, from the first column on.
    at_rows: [Edge; 2],
}

/// The outermost column (row) on one side, and the one within it.
type Edge = [Vec<f64>; 2];

/// The two columns (rows) whose straight line goes through a place, with their shares.
#[derive(Clone, Copy)]
pub struct Extrapolation {
    /// The place, which is whole.
    at: f64,
    from: [(usize, f64); 2],
    /// Whose [`Edge`] they are, where the place lies beyond all: 0 before the first, 1 behind the last.
    side: Option<usize>,
}

impl Continuation {
    /// The continuation of some coefficients.
    pub fn of(coefficients: &Sheet) -> Self {
        let Sheet {
            columns,
            rows,
            values,
        } = coefficients;
        let (columns, rows) = (*columns, *rows);
        let trend = Trend::of(coefficients);
        let off = |column: usize, row: usize| {
            values[row * columns + column] - trend.at(column as f64, row as f64)
        };
        let outermost = |count: usize| [[0, 1], [count - 1, count - 2]];
        let of_column = |column| (0..rows).map(|row| off(column, row)).collect();
        let of_row = |row| (0..columns).map(|column| off(column, row)).collect();
        Self {
            at_columns: outermost(columns).map(|pair| pair.map(of_column)),
            at_rows: outermost(rows).map(|pair| pair.map(of_row)),
            trend,
            columns,
            rows,
        }
    }

    /// The way to a column, which is whole.
    pub fn across(&self, column: f64) -> Extrapolation {
        Extrapolation::to(column, self.columns)
    }

    /// The way to a row, which is whole.
    pub fn down(&self, row: f64) -> Extrapolation {
        Extrapolation::to(row, self.rows)
    }

    /// The coefficient at a column and row. `own` has those of the sheet.
    #[inline]
    pub fn at(
        &self,
        across: &Extrapolation,
        down: &Extrapolation,
        own: impl Fn(usize, usize) -> f64,
    ) -> f64 {
        let mut rest = 0.0;
        for (j, (row, of_row)) in down.from.into_iter().enumerate() {
            for (i, (column, of_column)) in across.from.into_iter().enumerate() {
                let off = match (across.side, down.side) {
                    (Some(side), _) => self.at_columns[side][i][row],
                    (None, Some(side)) => self.at_rows[side][j][column],
                    (None, None) => own(column, row) - self.trend.at(column as f64, row as f64),
                };
                rest += of_row * of_column * off;
            }
        }
        self.trend.at(across.at, down.at) + rest
    }

    /// The coefficients at neighbouring columns of a row.
    pub fn line<const N: usize>(
        &self,
        across: &[Extrapolation; N],
        down: &Extrapolation,
        own: impl Fn(usize, usize) -> f64 + Copy,
    ) -> [f64; N] {
        let side = across.first().and_then(|way| way.side);
        let are_alike = across.iter().all(|way| way.side == side);
        if !are_alike || (side, down.side) == (None, None) {
            return across.each_ref().map(|way| self.at(way, down, own));
        }
        let mut rest = [0.0; N];
        for (j, (row, of_row)) in down.from.into_iter().enumerate() {
            for i in 0..2 {
                for (rest, way) in rest.iter_mut().zip(across) {
                    let (column, of_column) = way.from[i];
                    let off = match (side, down.side) {
                        (None, Some(side)) => self.at_rows[side][j][column],
                        (side, _) => self.at_columns[side.unwrap_or_default()][i][row],
                    };
                    *rest += of_row * of_column * off;
                }
            }
        }
        std::array::from_fn(|k| self.trend.at(across[k].at, down.at) + rest[k])
    }
}

impl Extrapolation {
    fn to(place: f64, count: usize) -> Self {
        let last = count - 1;
        let (from, side) = if place < 0.0 {
            ([(0, 1.0 - place), (1, place)], Some(0))
        } else if place > last as f64 {
            let beyond = place - last as f64;
            ([(last, 1.0 + beyond), (last - 1, -beyond)], Some(1))
        } else {
            ([(place as usize, 1.0), (place as usize, 0.0)], None)
        };
        Self {
            at: place,
            from,
            side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_goes_on_as_itself() {
        let quadratic = |u: f64, v: f64| 1.0 + 0.2 * u - 0.1 * v + 0.03 * u * u - 0.02 * u * v;
        let sheet = Sheet::of_values(9, 7, quadratic);
        let continuation = Continuation::of(&sheet);
        let own = |column: usize, row: usize| sheet.values[row * 9 + column];
        for (column, row) in [
            (-3.0, 2.0),
            (12.0, 3.0),
            (4.0, -2.0),
            (5.0, 9.0),
            (11.0, -4.0),
        ] {
            let found = continuation.at(&continuation.across(column), &continuation.down(row), own);
            assert!(
                (found - quadratic(column, row)).abs() < 1e-12,
                "{column} {row}: {found}"
            );
        }
    }

    /// Numbers that jump. At each side and corner the plain formula: what the two outermost columns and
    /// rows differ by goes on as a straight line along each axis.
    #[test]
    fn what_differs_from_the_trend_goes_on_straight_on_every_side() {
        let sheet = Sheet::of_values(9, 7, |u, v| (3.7 * u * u + 5.3 * v + 2.9 * u * v) % 4.0);
        let continuation = Continuation::of(&sheet);
        let trend = Trend::of(&sheet);
        let own = |column: usize, row: usize| sheet.values[row * 9 + column];
        let off =
            |column: usize, row: usize| own(column, row) - trend.at(column as f64, row as f64);
        let along = |at: f64, [outer, inner]: [usize; 2], of: &dyn Fn(usize) -> f64| {
            let beyond = (at - outer as f64).abs();
            (1.0 + beyond) * of(outer) - beyond * of(inner)
        };
        let columns = [(-3.0, [0, 1]), (4.0, [4, 4]), (10.0, [8, 7])];
        let rows = [(-2.0, [0, 1]), (2.0, [2, 2]), (9.0, [6, 5])];
        for (column, from_columns) in columns {
            for (row, from_rows) in rows {
                let of_row = |row| along(column, from_columns, &|column| off(column, row));
                let wanted = trend.at(column, row) + along(row, from_rows, &of_row);
                let found =
                    continuation.at(&continuation.across(column), &continuation.down(row), own);
                assert!(
                    (found - wanted).abs() < 1e-11,
                    "{column} {row}: {found} {wanted}"
                );
            }
        }
    }

    /// On all sides, at all corners, and over each border, also over both.
    #[test]
    fn a_line_has_the_bits_of_its_coefficients_alone() {
        for columns in [4, 9] {
            let jump = |u: f64, v: f64| (3.7 * u * u + 5.3 * v + 2.9 * u * v) % 4.0;
            let sheet = Sheet::of_values(columns, 7, jump);
            let continuation = Continuation::of(&sheet);
            let own = |column: usize, row: usize| sheet.values[row * columns + column];
            for first in -8..14 {
                let ways: [Extrapolation; 6] =
                    std::array::from_fn(|k| continuation.across(f64::from(first + k as i32)));
                for row in [-3.0, 2.0, 9.0] {
                    let down = continuation.down(row);
                    let line = continuation.line(&ways, &down, own).map(f64::to_bits);
                    let alone = ways.map(|way| continuation.at(&way, &down, own).to_bits());
                    assert_eq!(line, alone, "{columns}: {first} {row}");
                }
            }
        }
    }
}
