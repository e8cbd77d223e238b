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
    /// The coefficients of the outermost columns, from the first row on, less the trend.
    of_columns: Outermost,
    /// Those of the outermost rows, from the first column on.
    of_rows: Outermost,
}

/// What belongs to the first and the second number, and to the last and the one before it.
type Outermost = [[Vec<f64>; 2]; 2];

/// The two numbers of columns (rows) whose straight line goes through a place, with their shares.
#[derive(Clone, Copy)]
struct Line {
    numbers: [(usize, f64); 2],
    /// The side on which the place lies beyond all numbers: 0 before them, 1 behind them.
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
            of_columns: outermost(columns).map(|pair| pair.map(of_column)),
            of_rows: outermost(rows).map(|pair| pair.map(of_row)),
            trend,
            columns,
            rows,
        }
    }

    /// The coefficient at a column and row, which are whole. `own` has those of the sheet.
    pub fn at(&self, column: f64, row: f64, own: impl Fn(usize, usize) -> f64) -> f64 {
        let (across, down) = (Line::at(column, self.columns), Line::at(row, self.rows));
        let mut rest = 0.0;
        for (j, (row, share)) in down.numbers.into_iter().enumerate() {
            for (i, (column, part)) in across.numbers.into_iter().enumerate() {
                let off = match (across.side, down.side) {
                    (Some(side), _) => self.of_columns[side][i][row],
                    (None, Some(side)) => self.of_rows[side][j][column],
                    (None, None) => own(column, row) - self.trend.at(column as f64, row as f64),
                };
                rest += share * part * off;
            }
        }
        self.trend.at(column, row) + rest
    }
}

impl Line {
    fn at(place: f64, count: usize) -> Self {
        let last = count - 1;
        if place < 0.0 {
            Self {
                numbers: [(0, 1.0 - place), (1, place)],
                side: Some(0),
            }
        } else if place > last as f64 {
            let beyond = place - last as f64;
            Self {
                numbers: [(last, 1.0 + beyond), (last - 1, -beyond)],
                side: Some(1),
            }
        } else {
            Self {
                numbers: [(place as usize, 1.0), (place as usize, 0.0)],
                side: None,
            }
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
            let found = continuation.at(column, row, own);
            assert!(
                (found - quadratic(column, row)).abs() < 1e-12,
                "{column} {row}: {found}"
            );
        }
    }

    #[test]
    fn what_differs_from_the_trend_goes_on_straight_from_the_last_two() {
        let mut sheet = Sheet::of_values(9, 7, |u, v| ((3.0 * u + 5.0 * v) % 4.0) - 1.5);
        sheet.values[4 * 9 + 8] = 3.0;
        let continuation = Continuation::of(&sheet);
        let own = |column: usize, row: usize| sheet.values[row * 9 + column];
        let trend = Trend::of(&sheet);
        let off =
            |column: usize, row: usize| own(column, row) - trend.at(column as f64, row as f64);
        let wanted = trend.at(10.0, 4.0) + 3.0 * off(8, 4) - 2.0 * off(7, 4);
        let found = continuation.at(10.0, 4.0, own);
        assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
    }
}
