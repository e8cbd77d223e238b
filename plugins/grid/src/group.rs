//! The spline at a group of places, whose numbers go through the registers together.
//!
//! The splines along each axis have the places side by side. The rows of coefficients have their columns side by
//! side. Rows are weighted place by place, and then transposed, so that places lie side by side again.

use crate::basis::{GROUP, NO_SPLINES, Numbers, Splines, derivatives};
use crate::spline::{Line, NO_LINE, NO_PATCH, Patch, Spline, combine};

/// With so many orders of derivatives at most, a copy of the coefficients stays in registers for all of them. With
/// more, the compiler puts it into memory, and reading the rows themselves takes less time.
const FEW_ORDERS: usize = 3;

/// The spline and its first `N` orders of derivatives, in cells, at a group of places. It is aligned so that
/// no register of 512 bits crosses a border of the cache's lines.
#[repr(align(64))]
pub struct Group<const N: usize> {
    /// The splines along x and their derivatives.
    across: [Splines; N],
    /// The splines along y and their derivatives.
    down: [Splines; N],
    /// The rows of coefficients, weighted by the splines along y, place by place.
    weighted: [[Line; N]; GROUP],
    /// The same with the places side by side.
    rows: [Splines; N],
}

impl<const N: usize> Group<N> {
    /// A group that has no places yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            across: [NO_SPLINES; N],
            down: [NO_SPLINES; N],
            weighted: [[NO_LINE; N]; GROUP],
            rows: [NO_SPLINES; N],
        }
    }

    /// Takes up to [`GROUP`] places. Behind the last one, numbers mean nothing.
    #[inline(always)]
    pub fn take(&mut self, spline: &Spline, x: &[f64], y: &[f64]) {
        match (x.try_into(), y.try_into()) {
            (Ok(x), Ok(y)) => self.take_places(spline, x, y, GROUP),
            _ => {
                let [mut some_x, mut some_y] = [[0.0; GROUP]; 2];
                let places = some_x.iter_mut().zip(&mut some_y).zip(x.iter().zip(y));
                for ((some_x, some_y), (x, y)) in places {
                    (*some_x, *some_y) = (*x, *y);
                }
                self.take_places(spline, &some_x, &some_y, x.len());
            }
        }
    }

    /// Takes the first `count` of these places.
    #[inline(always)]
    pub fn take_places(&mut self, spline: &Spline, x: &Numbers, y: &Numbers, count: usize) {
        let places = spline.places(x, y);
        self.across = derivatives(&places.s);
        self.down = derivatives(&places.t);
        let mut patch = NO_PATCH;
        for (place, weighted) in self.weighted.iter_mut().enumerate().take(count) {
            let cell = [places.columns[place], places.rows[place]];
            let lines = spline.lines(cell, [x[place], y[place]], &mut patch);
            let copy: Patch;
            let lines = match N <= FEW_ORDERS {
                true => {
                    copy = lines.map(|line| *line);
                    copy.each_ref()
                }
                false => lines,
            };
            for (weighted, down) in weighted.iter_mut().zip(&self.down) {
                let weights = std::array::from_fn(|m| down[m][place]);
                *weighted = combine(&lines, &weights);
            }
        }
        transpose(&self.weighted, &mut self.rows);
    }

    /// The derivatives of order `a` along x and `b` along y, over a! b!, in cells.
    #[inline(always)]
    pub fn term(&self, a: usize, b: usize) -> Numbers {
        let (across, rows) = (&self.across[a], &self.rows[b]);
        let mut sums = [0.0; GROUP];
        for (place, sum) in sums.iter_mut().enumerate() {
            let product = |m: usize| rows[m][place] * across[m][place];
            *sum =
                (product(0) + product(1)) + (product(2) + product(3)) + (product(4) + product(5));
        }
        sums
    }
}

/// Puts the numbers of a group into a slice, which may be shorter but not longer.
#[inline(always)]
pub fn put<const N: usize>(numbers: &[f64; N], slice: &mut [f64]) {
    match <&mut [f64; N]>::try_from(&mut *slice) {
        Ok(whole) => *whole = *numbers,
        Err(_) => {
            for (place, number) in slice.iter_mut().zip(numbers) {
                *place = *number;
            }
        }
    }
}

/// Puts the places of a group side by side.
///
/// It is not compiled into loops for wide registers: there the compiler takes instructions that gather a register
/// from the cache number by number, which take longer.
#[inline(never)]
fn transpose<const N: usize>(weighted: &[[Line; N]; GROUP], rows: &mut [Splines; N]) {
    for (order, rows) in rows.iter_mut().enumerate() {
        for (m, row) in rows.iter_mut().enumerate() {
            for (number, weighted) in row.iter_mut().zip(weighted) {
                *number = weighted[order][m];
            }
        }
    }
}
