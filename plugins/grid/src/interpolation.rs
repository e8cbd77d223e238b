//! The coefficients of the spline that goes through all points.
//!
//! Along each axis the spline has a knot at every point but the two next to either end ("not a
//! knot"), as `scipy.interpolate.make_interp_spline(k=5)` has. Here it is written over knots at all
//! points, so that all cells are alike: at the points that are no knots the fifth derivative must
//! not jump. So n points have n + 4 coefficients.

use crate::banded::Band;
use crate::basis::{AT_KNOTS, BEFORE};
use crate::sheet::Sheet;

/// Coefficients beyond the points, at either end.
pub const BEYOND: usize = BEFORE;

/// The sixth difference of coefficients: the jump of the fifth derivative at the fourth of seven.
const JUMP: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];

/// The coefficients of the spline through the heights. There are [`BEYOND`] more of them than heights
/// on each side.
pub fn coefficients(heights: Sheet) -> Sheet {
    let along_y = along_columns(heights);
    along_columns(along_y.transposed()).transposed()
}

/// The coefficients along each column.
fn along_columns(heights: Sheet) -> Sheet {
    let (columns, points) = (heights.columns, heights.rows);
    let band = Band::new(&equations(points));
    let mut sides = Sheet::of(columns, points + 2 * BEYOND, 0.0);
    sides.values[BEYOND * columns..(points + BEYOND) * columns].copy_from_slice(&heights.values);
    drop(heights);
    band.solve(&mut sides.values, columns);
    sides
}

/// The equations for so many points: two without a jump, one for each point, two without a jump.
fn equations(points: usize) -> Vec<(usize, Vec<f64>)> {
    let jump = |first: usize| (first, JUMP.to_vec());
    let through = (0..points).map(|point| (point, AT_KNOTS.to_vec()));
    let at_start = [jump(0), jump(1)];
    let at_end = [jump(points - 4), jump(points - 3)];
    at_start.into_iter().chain(through).chain(at_end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::GROUP;

    /// Six points leave one polynomial; with more, a polynomial is its own spline.
    #[test]
    fn a_polynomial_of_degree_5_is_its_own_spline() {
        let polynomial = |u: f64| 1.0 + u * (0.5 - u * (0.25 + u * (0.1 - u * (0.02 - 0.003 * u))));
        for points in [6, 7, 8, 13, 40] {
            let mut sheet = Sheet::of(6, points, 0.0);
            let over = 5.0 / (points - 1) as f64;
            for (row, line) in sheet.lines_mut().enumerate() {
                line.fill(polynomial(row as f64 * over));
            }
            let found = coefficients(sheet);
            assert_eq!((found.columns, found.rows), (10, points + 4));
            for cell in 0..points - 1 {
                let weights =
                    crate::basis::derivative::<0>(&[0.5; GROUP]).map(|weights| weights[0]);
                let column = |row: usize| found.values[row * 10 + 5];
                let value: f64 = (0..6).map(|m| weights[m] * column(cell + m)).sum();
                let wanted = polynomial((cell as f64 + 0.5) * over);
                assert!(
                    (value - wanted).abs() < 1e-11,
                    "{points} {cell}: {value} {wanted}"
                );
            }
        }
    }
}
