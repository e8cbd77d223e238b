//! The spline: its coefficients, and its values and slopes.

use crate::basis::{BEFORE, GROUP, Numbers, SPLINES};
use crate::continuation::{Continuation, Extrapolation};
use crate::edges;
use crate::interpolation::{BEYOND, coefficients};
use crate::sheet::Sheet;

/// Coefficients that are read at a time: as many as a register of 512 bits holds. Six of them count.
pub const LANES: usize = 8;

/// Coefficients of a row.
pub type Line = [f64; LANES];

/// Coefficients that are zero.
pub const NO_LINE: Line = [0.0; LANES];

/// The 36 coefficients that count at a place, row by row.
pub type Patch = [Line; SPLINES];

/// The coefficients of a place that is infinite or no number.
pub const NO_PATCH: Patch = [[f64::NAN; LANES]; SPLINES];

/// The same where they lie.
pub type Lines<'a> = [&'a Line; SPLINES];

/// The cells of a group of places, and where the places lie in them.
pub struct Places {
    /// The column of coefficients of each cell. Where it is 2⁵¹ or more, either way, it may be any number that no
    /// cell has.
    pub columns: [i64; GROUP],
    /// The same for rows.
    pub rows: [i64; GROUP],
    /// Places along x, from 0 to 1.
    pub s: Numbers,
    /// Places along y, from 0 to 1.
    pub t: Numbers,
}

/// The share of the shorter side by which coefficients around the spline's own are kept. The nose reaches
/// beyond the part, and a coefficient takes time.
const KEPT_SHARE: usize = 2;

/// Most coefficients that are kept on each side. A large map takes little more memory for them.
const MOST_KEPT: usize = 128;

/// A tensor B-spline of degree 5 over knots at all points of a regular grid. It has a value
/// everywhere and is C⁴ everywhere.
///
/// Beyond the points its coefficients go on as the quadratic of best fit, plus a straight line.
#[derive(Debug, Clone)]
pub struct Spline {
    /// The spline's own coefficients and those that are kept around them. Two more numbers follow the last
    /// row: eight numbers are read at a time, and six of them count.
    coefficients: Sheet,
    /// Coefficients that are kept on each side.
    kept: usize,
    continuation: Continuation,
    /// 1 / pitch, 1/mm.
    pub per: [f64; 2],
    /// Number of the column (row) of coefficients at x = 0 (y = 0).
    origin: [f64; 2],
}

impl Spline {
    /// The spline through heights without holes. `first` is the place of the first height and
    /// `pitch` the distance of neighbours, mm.
    #[cfg(test)]
    pub fn through(heights: Sheet, first: [f64; 2], pitch: [f64; 2]) -> Self {
        Self::of(coefficients(heights), first, pitch)
    }

    /// The same, carried on by `wide`: the heights in the middle of a sheet with `margin` heights more
    /// on each side. `first` is the place of the first height within the margin.
    pub fn carried_on(
        heights: Sheet,
        wide: Sheet,
        margin: usize,
        first: [f64; 2],
        pitch: [f64; 2],
    ) -> Self {
        let mut outer = coefficients(wide);
        edges::join(&coefficients(heights), &mut outer, margin);
        let first = [0, 1].map(|axis| first[axis] - pitch[axis] * margin as f64);
        Self::of(outer, first, pitch)
    }

    fn of(coefficients: Sheet, first: [f64; 2], pitch: [f64; 2]) -> Self {
        let before = BEYOND as f64;
        let kept = coefficients.columns.min(coefficients.rows) / KEPT_SHARE;
        let kept = kept.min(MOST_KEPT);
        let mut spline = Self {
            continuation: Continuation::of(&coefficients),
            coefficients: coefficients.with_margin(kept),
            kept,
            per: pitch.map(f64::recip),
            origin: [before - first[0] / pitch[0], before - first[1] / pitch[1]],
        };
        spline.keep_around();
        let more = [0.0; LANES - SPLINES];
        spline.coefficients.values.reserve_exact(more.len());
        spline.coefficients.values.extend(more);
        spline
    }

    /// Calculates the coefficients that are kept around the spline's own.
    fn keep_around(&mut self) {
        let Sheet { columns, rows, .. } = self.coefficients;
        let [own_columns, own_rows] = self.own().map(|count| self.kept..self.kept + count);
        let from_own = |at: usize| at as f64 - self.kept as f64;
        let of_column = |column| self.continuation.across(from_own(column));
        let ways: Vec<Extrapolation> = (0..columns).map(of_column).collect();
        for row in 0..rows {
            let down = self.continuation.down(from_own(row));
            for (column, across) in ways.iter().enumerate() {
                if !(own_rows.contains(&row) && own_columns.contains(&column)) {
                    self.coefficients.values[row * columns + column] = self.beyond(across, &down);
                }
            }
        }
    }

    /// Columns and rows of the spline's own coefficients.
    fn own(&self) -> [usize; 2] {
        let Sheet { columns, rows, .. } = self.coefficients;
        [columns, rows].map(|count| count - 2 * self.kept)
    }

    /// The cells of places.
    #[inline(always)]
    pub fn places(&self, x: &Numbers, y: &Numbers) -> Places {
        let (columns, s) = cells(x, self.per[0], self.origin[0]);
        let (rows, t) = cells(y, self.per[1], self.origin[1]);
        Places {
            columns,
            rows,
            s,
            t,
        }
    }

    /// The coefficients that count at a place (x, y) in a cell. Those that are not kept are put into `patch`. They
    /// are NaN where the place is infinite or no number.
    #[inline(always)]
    pub fn lines<'a>(
        &'a self,
        [column, row]: [i64; 2],
        place: [f64; 2],
        patch: &'a mut Patch,
    ) -> Lines<'a> {
        if let Some(lines) = self.lines_of_cell(column, row) {
            return lines;
        }
        *patch = self.patch_at(place);
        patch.each_ref()
    }

    /// The coefficients that count at a place (x, y) where not all are kept.
    #[cold]
    fn patch_at(&self, place: [f64; 2]) -> Patch {
        let [u, v] = [0, 1].map(|axis| place[axis] * self.per[axis] + self.origin[axis]);
        match u.is_finite() && v.is_finite() {
            true => self.patch_outside(u.floor(), v.floor()),
            false => NO_PATCH,
        }
    }

    /// The coefficients of a cell, where all are kept.
    #[inline(always)]
    fn lines_of_cell(&self, column: i64, row: i64) -> Option<Lines<'_>> {
        let Sheet {
            columns,
            rows,
            values,
        } = &self.coefficients;
        // A number below zero becomes a very large one. A row has eight coefficients at least, those of the margin
        // included.
        let first = |at: i64| at.wrapping_add(self.kept as i64 - BEFORE as i64) as usize;
        let (left, top) = (first(column), first(row));
        if left >= columns.wrapping_sub(SPLINES - 1) || top >= rows.wrapping_sub(SPLINES - 1) {
            return None;
        }
        let (a, below) = values
            .get(top * columns + left..)?
            .split_at_checked(*columns)?;
        let (b, below) = below.split_at_checked(*columns)?;
        let (c, below) = below.split_at_checked(*columns)?;
        let (d, below) = below.split_at_checked(*columns)?;
        let (e, f) = below.split_at_checked(*columns)?;
        Some([
            a.first_chunk()?,
            b.first_chunk()?,
            c.first_chunk()?,
            d.first_chunk()?,
            e.first_chunk()?,
            f.first_chunk()?,
        ])
    }

    fn patch_outside(&self, column: f64, row: f64) -> Patch {
        let at = |middle: f64, shift: f64| middle + (shift - BEFORE as f64);
        let shifts: [f64; SPLINES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let columns = shifts.map(|right| self.continuation.across(at(column, right)));
        let mut patch = [NO_LINE; SPLINES];
        for (line, down) in patch.iter_mut().zip(shifts) {
            let down = self.continuation.down(at(row, down));
            let values = self
                .continuation
                .line(&columns, &down, self.own_coefficient());
            for (place, value) in line.iter_mut().zip(values) {
                *place = value;
            }
        }
        patch
    }

    /// A coefficient beyond the spline's own. One of these comes out but for rounding.
    fn beyond(&self, across: &Extrapolation, down: &Extrapolation) -> f64 {
        self.continuation.at(across, down, self.own_coefficient())
    }

    /// The spline's own coefficient at a column and row.
    fn own_coefficient(&self) -> impl Fn(usize, usize) -> f64 + Copy {
        |column, row| {
            let place = (row + self.kept) * self.coefficients.columns + column + self.kept;
            self.coefficients.values[place]
        }
    }
}

/// 1.5·2⁵²: a whole number below 2⁵¹ that is added to it stands in its last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// The cells of places along an axis, and where the places lie in them.
#[inline(always)]
fn cells(places: &Numbers, per: f64, origin: f64) -> ([i64; GROUP], Numbers) {
    let (mut cells, mut rest) = ([0; GROUP], [0.0; GROUP]);
    for ((cell, rest), place) in cells.iter_mut().zip(&mut rest).zip(places) {
        let u = place * per + origin;
        let whole = u.floor();
        *rest = u - whole;
        *cell = ((whole + WHOLE).to_bits() as i64).wrapping_sub(WHOLE.to_bits() as i64);
    }
    (cells, rest)
}

/// The sum of the rows, weighted.
#[inline(always)]
pub fn combine(lines: &Lines<'_>, weights: &[f64; SPLINES]) -> Line {
    let [a, b, c, d, e, f] = lines;
    let mut sums = NO_LINE;
    // Without a loop over the rows, so that one over a register's numbers is left.
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k];
        *sum = *sum + weights[3] * d[k] + weights[4] * e[k] + weights[5] * f[k];
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::{self, Splines};

    fn wavy(x: f64, y: f64) -> f64 {
        let fraction = |n: f64| n - n.floor();
        fraction(12.9898 * x + 78.233 * y) - 0.5 + 0.1 * x * x
    }

    /// A spline through numbers that jump from point to point, so that nothing is smooth by chance.
    fn spline() -> Spline {
        let mut heights = Sheet::of(12, 9, 0.0);
        for (row, line) in heights.lines_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = wavy(0.5 * column as f64 - 2.0, 0.3 * row as f64 + 1.0);
            }
        }
        Spline::through(heights, [-2.0, 1.0], [0.5, 0.3])
    }

    /// 2⁵¹.
    const FAR: f64 = 2_251_799_813_685_248.0;

    #[test]
    fn cells_are_whole_numbers_below_their_places() {
        for places in [
            [-0.0, 0.0, -1.0, -1.5, 2.0, 2.999, 1e9 + 0.5, -1e9 - 0.5],
            [FAR - 1.0, 1.0 - FAR, 0.1, -0.1, 7.0, -7.0, 1e15, -1e15],
        ] {
            let (cells, rest) = cells(&places, 1.0, 0.0);
            for (place, (cell, rest)) in places.iter().zip(cells.into_iter().zip(rest)) {
                assert_eq!((cell as f64, rest), (place.floor(), place - place.floor()));
            }
        }
        // No cell of a spline is so far away.
        let far = [
            2.0 * FAR + 1.0,
            -3.0 * FAR,
            1e300,
            -1e300,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            -f64::NAN,
        ];
        let (cells, _) = cells(&far, 1.0, 0.0);
        let are_far = cells.iter().all(|cell| cell.unsigned_abs() >= 1 << 51);
        assert!(are_far, "{cells:?}");
    }

    #[test]
    fn the_spline_goes_through_all_points() {
        let spline = spline();
        for row in 0..9 {
            for column in 0..12 {
                let (x, y) = (0.5 * f64::from(column) - 2.0, 0.3 * f64::from(row) + 1.0);
                let (found, wanted) = (spline.height(x, y), wavy(x, y));
                assert!((found - wanted).abs() < 1e-12, "{x} {y}: {found} {wanted}");
            }
        }
    }

    /// In a cell the spline is a polynomial of degree 5. Over a border, also beyond the points, only the
    /// fifth derivative may jump.
    #[test]
    fn value_and_four_derivatives_go_on_over_every_border() {
        let spline = spline();
        let orders = |s: f64| basis::derivatives::<5>(&[s; GROUP]);
        let dot = |line: &Line, splines: &Splines| -> f64 {
            let products = line.iter().zip(splines).map(|(c, spline)| c * spline[0]);
            products.sum()
        };
        for column in -30..60 {
            let patch = |column: i64| match spline.lines_of_cell(column, 3) {
                Some(lines) => lines.map(|line| *line),
                None => spline.patch_outside(column as f64, 3.0),
            };
            let patches = [column - 1, column].map(patch);
            for (before, after) in patches[0].iter().zip(&patches[1]) {
                for (of_end, of_start) in orders(1.0).iter().zip(&orders(0.0)) {
                    let (before, after) = (dot(before, of_end), dot(after, of_start));
                    let size = before.abs().max(1.0);
                    assert!((before - after).abs() < 1e-10 * size, "{column}");
                }
            }
        }
    }

    #[test]
    fn what_is_kept_around_is_what_a_place_farther_out_gets() {
        let spline = spline();
        // The spline has 16 columns and 13 rows of its own, and six are kept on each side.
        assert_eq!((spline.own(), spline.kept), ([16, 13], 6));
        for (column, row) in [(-4, 3), (4, -1), (-1, -4), (18, 15), (15, 2), (3, 15)] {
            let kept = spline.lines_of_cell(column, row).unwrap();
            let patch = spline.patch_outside(column as f64, row as f64);
            for (line, (kept, calculated)) in (row - 2..).zip(kept.iter().zip(&patch)) {
                for place in 0..SPLINES {
                    let is_own =
                        (0..13).contains(&line) && (0..16).contains(&(column - 2 + place as i64));
                    let far = (kept[place] - calculated[place]).abs();
                    let bound = if is_own {
                        1e-14 * calculated[place].abs().max(1.0)
                    } else {
                        0.0
                    };
                    assert!(far <= bound, "{column} {row}: {far}");
                }
            }
        }
        assert!(spline.lines_of_cell(-5, 3).is_none());
        assert!(spline.lines_of_cell(3, 16).is_none());
    }

    #[test]
    fn a_quadratic_goes_on_as_itself_and_far_places_have_numbers() {
        let quadratic = |x: f64, y: f64| 0.02 * x * x - 0.03 * x * y + 0.01 * y + 0.5;
        let mut heights = Sheet::of(20, 30, 0.0);
        for (row, line) in heights.lines_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = quadratic(0.1 * column as f64, 0.2 * row as f64);
            }
        }
        let spline = Spline::through(heights, [0.0, 0.0], [0.1, 0.2]);
        for (x, y) in [
            (1.0, 2.0),
            (-0.5, 3.0),
            (2.5, 6.5),
            (-0.8, 8.0),
            (1e20, 3.0),
        ] {
            let (found, wanted) = (spline.height(x, y), quadratic(x, y));
            assert!(
                (found - wanted).abs() < 1e-9 * wanted.abs().max(1.0),
                "{found} {wanted}"
            );
        }
        assert!(spline.height(1e9, -1e9).is_finite());
        assert!(spline.height(f64::NAN, 0.0).is_nan());
        assert!(spline.height(f64::INFINITY, 0.0).is_nan());
    }
}
