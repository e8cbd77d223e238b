//! Strips: series of a few curves, with their coefficients of one order side by side.
//!
//! A loop goes from curve to curve of a strip and has whole series in its body. Where the body has
//! neither loops nor calls, the compiler puts the curves side by side in [vector
//! registers](crate::registers). The operations of a curve and their order are those that it has alone.

use crate::{Lanes, Scalar, Series, Taylor};

/// Number of curves in a strip. The coefficients of a few series stay in the cache of the first level,
/// 1.3 KB each.
pub const STRIP: usize = 32;

/// The numbers of a strip: one for each curve.
pub type Column = [f64; STRIP];

/// The first `N` coefficients of the curves of a strip: those of one order side by side.
pub type Strip<const N: usize> = [Column; N];

/// A strip of which nothing is known.
pub const fn blank<const N: usize>() -> Strip<N> {
    [[0.0; STRIP]; N]
}

/// Puts the first coefficients of up to [`STRIP`] curves side by side.
#[inline(always)]
pub fn gather<const N: usize>(curves: &[Series], strip: &mut Strip<N>) {
    for (k, column) in strip.iter_mut().enumerate() {
        for (place, curve) in column.iter_mut().zip(curves) {
            *place = curve[k];
        }
    }
}

/// Gives the curves the first coefficients of a strip. Those of higher orders stay as they are.
///
/// It is not compiled into loops for wide registers: there the compiler takes instructions that scatter a
/// register, which take longer than storing its numbers one by one.
#[inline(never)]
pub fn scatter<const N: usize>(strip: &Strip<N>, curves: &mut [Series]) {
    for (k, column) in strip.iter().enumerate() {
        for (coefficient, curve) in column.iter().zip(&mut *curves) {
            curve[k] = *coefficient;
        }
    }
}

/// A number that holds the values of one curve or of several of a strip: a formula goes through all of them
/// at once.
pub trait Group: Scalar {
    /// How many curves there are in a group. A strip is a whole number of groups.
    const WIDTH: usize;

    /// The series of a group of curves of a strip, from curve `first` on.
    fn take<const N: usize>(strip: &Strip<N>, first: usize) -> Taylor<Self, N>;

    /// Puts the series of a group into their places in a strip.
    fn put<const N: usize>(first: usize, series: Taylor<Self, N>, strip: &mut Strip<N>);
}

impl Group for f64 {
    const WIDTH: usize = 1;

    #[inline(always)]
    fn take<const N: usize>(strip: &Strip<N>, first: usize) -> Taylor<Self, N> {
        let mut series = Taylor([0.0; N]);
        for (coefficient, column) in series.0.iter_mut().zip(strip) {
            *coefficient = column[first];
        }
        series
    }

    #[inline(always)]
    fn put<const N: usize>(first: usize, series: Taylor<Self, N>, strip: &mut Strip<N>) {
        for (column, c) in strip.iter_mut().zip(series.0) {
            column[first] = c;
        }
    }
}

impl<const WIDTH: usize> Group for Lanes<WIDTH> {
    const WIDTH: usize = {
        assert!(
            STRIP.is_multiple_of(WIDTH),
            "a strip is a whole number of groups"
        );
        WIDTH
    };

    #[inline(always)]
    fn take<const N: usize>(strip: &Strip<N>, first: usize) -> Taylor<Self, N> {
        let mut series = Taylor([Lanes([0.0; WIDTH]); N]);
        for (coefficient, column) in series.0.iter_mut().zip(strip) {
            coefficient.0.copy_from_slice(&column[first..first + WIDTH]);
        }
        series
    }

    #[inline(always)]
    fn put<const N: usize>(first: usize, series: Taylor<Self, N>, strip: &mut Strip<N>) {
        for (column, c) in strip.iter_mut().zip(series.0) {
            column[first..first + WIDTH].copy_from_slice(&c.0);
        }
    }
}

/// Where the groups of so many curves of a strip begin.
#[inline(always)]
pub fn groups<S: Group>(curves: usize) -> impl Iterator<Item = usize> {
    (0..curves.min(STRIP).div_ceil(S::WIDTH)).map(|group| group * S::WIDTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_cover_each_curve_once() {
        for curves in 0..=STRIP {
            assert!(groups::<f64>(curves).eq(0..curves));
            let in_eights = groups::<Lanes<8>>(curves);
            assert!(in_eights.eq((0..curves).step_by(8)), "{curves}");
        }
    }

    #[test]
    fn curves_come_back_from_a_strip_and_keep_their_higher_orders() {
        let curves: Vec<Series> = (0..5)
            .map(|i| [0.1, 0.2, 0.3, 0.4, 0.5].map(|c| c + f64::from(i)))
            .collect();
        let mut strip: Strip<3> = blank();
        gather(&curves, &mut strip);
        assert_eq!(f64::take(&strip, 4).0, [4.1, 4.2, 4.3]);
        let other = Taylor([7.0, 8.0, 9.0]);
        f64::put(2, other, &mut strip);
        assert_eq!(
            (f64::take(&strip, 2), f64::take(&strip, 3).0[0]),
            (other, 3.1)
        );
        gather(&curves, &mut strip);
        let mut back = vec![[-1.0; 5]; 5];
        scatter(&strip, &mut back);
        for (back, curve) in back.iter().zip(&curves) {
            assert_eq!((&back[..3], &back[3..]), (&curve[..3], &[-1.0; 2][..]));
        }
    }
}
