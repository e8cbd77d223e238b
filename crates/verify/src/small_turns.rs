//! Sine and cosine of angles that are a little further round than others whose sine and cosine are known.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::sines_and_cosines;

use crate::search_limits::WIDTH;

/// Turns up to here have series with these terms, rad: what is left out is below 3e-17.
const LARGEST: f64 = 0.06;
/// The terms of sin δ behind δ, without their powers of δ.
const SINE: [f64; 3] = [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0];
/// The terms of 1 − cos δ.
const VERSINE: [f64; 4] = [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0];

/// Angles with their sines and cosines, at most [`WIDTH`].
pub(crate) struct TurnStarts {
    theta: [f64; WIDTH],
    sine: [f64; WIDTH],
    cosine: [f64; WIDTH],
}

impl TurnStarts {
    /// Those of these angles, rad.
    pub fn at(theta: &[f64]) -> Self {
        let empty = [0.0; WIDTH];
        let mut starts = Self {
            theta: empty,
            sine: empty,
            cosine: empty,
        };
        let count = theta.len();
        starts.theta[..count].copy_from_slice(theta);
        let (sine, cosine) = (&mut starts.sine[..count], &mut starts.cosine[..count]);
        sines_and_cosines(theta, sine, cosine);
        starts
    }

    /// Sine and cosine of each angle, rad, from the start in its place where all of them are near.
    pub fn turn(&self, theta: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
        if !in_widest(SmallTurns(self, theta, sines, cosines)) {
            sines_and_cosines(theta, sines, cosines);
        }
    }
}

/// The loop of [`TurnStarts::turn`]; gives whether all turns are small.
struct SmallTurns<'a>(&'a TurnStarts, &'a [f64], &'a mut [f64], &'a mut [f64]);

impl Loop for SmallTurns<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self(starts, theta, sines, cosines) = self;
        let count = theta.len().min(WIDTH);
        // Arrays of its own: the compiler sees that no other slice overlaps them.
        let [mut found_sine, mut found_cosine] = [[0.0; WIDTH]; 2];
        let mut all_small = true;
        for i in 0..count {
            let (sine, cosine) = (starts.sine[i], starts.cosine[i]);
            let turn = theta[i] - starts.theta[i];
            let square = turn * turn;
            let of_turn = turn + turn * square * sum(SINE, square);
            let versine = square * sum(VERSINE, square);
            found_sine[i] = sine + (cosine * of_turn - sine * versine);
            found_cosine[i] = cosine - (sine * of_turn + cosine * versine);
            all_small &= turn.abs() <= LARGEST;
        }
        sines[..count].copy_from_slice(&found_sine[..count]);
        cosines[..count].copy_from_slice(&found_cosine[..count]);
        all_small
    }
}

/// A polynomial, its lowest term first.
#[inline(always)]
fn sum<const N: usize>(terms: [f64; N], at: f64) -> f64 {
    let mut sum = 0.0;
    for term in terms.into_iter().rev() {
        sum = sum * at + term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;

    use super::*;

    /// The largest error of sine and cosine of angles that are so much further round, against those of the core, which are libm's.
    fn largest_error(turn: f64) -> f64 {
        let starts: Vec<f64> = (0..WIDTH).map(|i| 0.05 * i as f64).collect();
        let theta: Vec<f64> = starts.iter().map(|start| start + turn).collect();
        let (mut sines, mut cosines) = (vec![0.0; WIDTH], vec![0.0; WIDTH]);
        TurnStarts::at(&starts).turn(&theta, &mut sines, &mut cosines);
        let found = sines.into_iter().zip(cosines).zip(theta);
        let errors = found.map(|((sine, cosine), theta)| {
            let (true_sine, true_cosine) = Scalar::sin_cos(theta);
            f64::max((sine - true_sine).abs(), (cosine - true_cosine).abs())
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn small_turns_and_large_ones_have_the_sines_of_the_core() {
        for turn in [0.0, 1e-9, 3e-4, -0.02, 0.0599, -0.0599] {
            assert!(largest_error(turn) < 4e-16, "{turn}");
        }
        for turn in [0.0601, -1.0, 6.2] {
            assert_eq!(largest_error(turn), 0.0, "{turn}");
        }
    }

    #[test]
    fn an_angle_that_is_no_number_has_no_sine() {
        let (mut sines, mut cosines) = ([0.0; 2], [0.0; 2]);
        let starts = TurnStarts::at(&[1.0, 2.0]);
        starts.turn(&[1.0, f64::NAN], &mut sines, &mut cosines);
        assert_eq!(sines[0], Scalar::sin(1.0));
        assert!(sines[1].is_nan() && cosines[1].is_nan());
    }
}
