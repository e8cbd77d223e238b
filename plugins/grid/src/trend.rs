//! The quadratic of best fit.

use crate::sheet::Sheet;

/// The terms 1, u, v, u², uv, v².
const TERMS: usize = 6;

/// A pivot below this share of the largest one is none: the points lie on a line or on a conic.
const SMALLEST_PIVOT: f64 = 1e-10;

/// A quadratic over the numbers of rows and columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// The middle of the sheet, in columns and rows.
    middle: [f64; 2],
    /// 1 / half the size of the sheet.
    per: f64,
    terms: [f64; TERMS],
}

impl Trend {
    /// The quadratic with the least squares of distances from all numbers of a sheet that are not
    /// NaN. Where they leave it open, it has fewer terms.
    pub fn of(sheet: &Sheet) -> Self {
        let half = 0.5 * (sheet.columns.max(sheet.rows) as f64 - 1.0);
        let mut trend = Self {
            middle: [
                0.5 * (sheet.columns as f64 - 1.0),
                0.5 * (sheet.rows as f64 - 1.0),
            ],
            per: 1.0 / half.max(1.0),
            terms: [0.0; TERMS],
        };
        let mut squares = [[0.0; TERMS + 1]; TERMS];
        for (row, line) in sheet.lines().enumerate() {
            // Sums of a row first: fewer digits are lost.
            let mut of_row = [[0.0; TERMS + 1]; TERMS];
            for (column, value) in line.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
                let terms = trend.basis(column as f64, row as f64);
                for (sums, term) in of_row.iter_mut().zip(terms) {
                    for (sum, other) in sums.iter_mut().zip(terms) {
                        *sum += term * other;
                    }
                    sums[TERMS] += term * value;
                }
            }
            for (sums, of_row) in squares.iter_mut().zip(of_row) {
                for (sum, more) in sums.iter_mut().zip(of_row) {
                    *sum += more;
                }
            }
        }
        trend.terms = solve(squares);
        trend
    }

    fn basis(&self, column: f64, row: f64) -> [f64; TERMS] {
        let u = (column - self.middle[0]) * self.per;
        let v = (row - self.middle[1]) * self.per;
        [1.0, u, v, u * u, u * v, v * v]
    }

    /// The quadratic at a place, which may lie outside of the sheet.
    pub fn at(&self, column: f64, row: f64) -> f64 {
        let terms = self.basis(column, row);
        terms.iter().zip(self.terms).map(|(term, c)| term * c).sum()
    }

    /// Adds `factor` times the quadratic to all numbers of a sheet.
    pub fn add_to(&self, sheet: &mut Sheet, factor: f64) {
        self.add_at(sheet, factor, [0.0; 2], [1.0; 2]);
    }

    /// The same for a sheet whose first number lies at the column and row `first` of the trend's, and
    /// whose neighbours are `step` columns and rows apart.
    pub fn add_at(&self, sheet: &mut Sheet, factor: f64, first: [f64; 2], step: [f64; 2]) {
        for (row, line) in sheet.lines_mut().enumerate() {
            let v = first[1] + step[1] * row as f64;
            for (column, value) in line.iter_mut().enumerate() {
                *value += factor * self.at(first[0] + step[0] * column as f64, v);
            }
        }
    }
}

/// The solution of the normal equations, by elimination with the largest pivot on the diagonal. A
/// term without a pivot is 0.
fn solve(mut rows: [[f64; TERMS + 1]; TERMS]) -> [f64; TERMS] {
    let mut free: Vec<usize> = (0..TERMS).collect();
    let mut order = Vec::with_capacity(TERMS);
    let mut largest: f64 = 0.0;
    while let Some(place) = (0..free.len()).max_by(|a, b| {
        let pivot = |place: &usize| rows[free[*place]][free[*place]];
        pivot(a).total_cmp(&pivot(b))
    }) {
        let pivot = free.swap_remove(place);
        let size = rows[pivot][pivot];
        largest = largest.max(size);
        if size <= SMALLEST_PIVOT * largest || size <= 0.0 {
            break;
        }
        let of_pivot = rows[pivot];
        for other in &free {
            let share = of_pivot[*other] / size;
            for (entry, upper) in rows[*other].iter_mut().zip(of_pivot) {
                *entry -= share * upper;
            }
        }
        order.push(pivot);
    }
    let mut terms = [0.0; TERMS];
    for (done, pivot) in order.iter().enumerate().rev() {
        let later = order.iter().skip(done + 1);
        let known: f64 = later.map(|term| rows[*pivot][*term] * terms[*term]).sum();
        terms[*pivot] = (rows[*pivot][TERMS] - known) / rows[*pivot][*pivot];
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(value: impl Fn(f64, f64) -> f64) -> Sheet {
        Sheet::of_values(40, 30, value)
    }

    #[test]
    fn a_quadratic_is_its_own_trend() {
        let quadratic =
            |u: f64, v: f64| 3.0 - 0.2 * u + 0.1 * v + 0.03 * u * u - 0.02 * u * v + v * v;
        let mut of_all = sheet(quadratic);
        // A hole changes nothing.
        of_all.values[45] = f64::NAN;
        let trend = Trend::of(&of_all);
        for (u, v) in [(0.0, 0.0), (17.5, 3.25), (-20.0, 55.0)] {
            let (found, wanted) = (trend.at(u, v), quadratic(u, v));
            assert!(
                (found - wanted).abs() <= 1e-11 * wanted.abs().max(100.0),
                "{found} {wanted}"
            );
        }
    }

    #[test]
    fn points_on_a_line_leave_no_term_without_bound() {
        let line = sheet(|_, v| if v == 4.0 { 2.0 } else { f64::NAN });
        let trend = Trend::of(&line);
        assert!((trend.at(11.0, 4.0) - 2.0).abs() < 1e-12);
        assert!(trend.at(11.0, 30.0).abs() < 100.0);
        assert_eq!(Trend::of(&sheet(|_, _| f64::NAN)).at(1.0, 2.0), 0.0);
    }
}
