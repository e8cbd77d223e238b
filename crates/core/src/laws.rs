//! The spiral law ρ = ℓ(N) and the spindle law ω(N).

use std::f64::consts::TAU;

use crate::{Piece, PiecewisePolynomial, Series};

/// The spiral law ρ = ℓ(N): the compensator's radial parameter, mm, against revolutions.
///
/// The knots of the law matter: a bound that uses a 4th derivative does not hold across a knot.
pub type SpiralLaw = PiecewisePolynomial;

/// The spindle law ω(N), stored as the time t(N) that the spindle takes for N revolutions.
///
/// The polynomial is the time, not the speed, because control points need t at N exactly and the
/// integral of 1/ω has no closed form.
#[derive(Debug, Clone, PartialEq)]
pub struct SpindleLaw {
    time: PiecewisePolynomial,
}

impl SpindleLaw {
    /// The law of a constant speed in rad/s.
    pub fn constant(speed: f64) -> Self {
        let mut time = PiecewisePolynomial::new();
        time.push(f64::MAX, [0.0, TAU / speed, 0.0, 0.0, 0.0, 0.0]);
        Self { time }
    }

    /// The law for a time t(N) in s. t must grow with N.
    pub fn from_time(time: PiecewisePolynomial) -> Self {
        Self { time }
    }

    /// Whether the speed is the same all along.
    pub fn is_constant(&self) -> bool {
        let pieces = self.time.pieces();
        pieces.iter().all(|piece| {
            let [_, rate, change @ ..] = piece.coefficients;
            Some(rate) == pieces.first().map(|first| first.coefficients[1])
                && change.iter().all(|c| *c == 0.0)
        })
    }

    /// The time t(N) in s as a piecewise polynomial.
    pub fn as_time(&self) -> &PiecewisePolynomial {
        &self.time
    }

    /// The same schedule with every speed multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        let slower = |piece: &Piece| Piece {
            start: piece.start,
            coefficients: piece.coefficients.map(|c| c / factor),
        };
        let pieces = self.time.pieces().iter().map(slower);
        Self {
            time: PiecewisePolynomial::from_pieces(pieces.collect(), self.time.end()),
        }
    }

    /// The law between `from` and `to` revolutions: what one block needs.
    pub fn window(&self, from: f64, to: f64) -> Self {
        Self {
            time: self.time.window(from, to),
        }
    }

    /// The time at which the spindle has made `n` revolutions, s.
    pub fn time_at(&self, n: f64) -> f64 {
        self.time.value(n)
    }

    /// The speed of the spindle after `n` revolutions, rad/s.
    pub fn speed_at(&self, n: f64) -> f64 {
        TAU / self.time.rate(n)
    }

    /// The times at which the spindle has made so many revolutions, s. `times` has the length of `n`.
    pub fn times_at(&self, n: &[f64], times: &mut [f64]) {
        self.time.values(n, times);
    }

    /// The speeds of the spindle after so many revolutions, rad/s. `speeds` has the length of `n`.
    pub fn speeds_at(&self, n: &[f64], speeds: &mut [f64]) {
        self.time.rates(n, speeds);
        speeds.iter_mut().for_each(|speed| *speed = TAU / *speed);
    }

    /// The revolutions after the time `time`, s, to rounding. `near` is a guess, in revolutions.
    ///
    /// NaN if the law has no value there.
    pub fn revolutions_at(&self, time: f64, near: f64) -> f64 {
        match self.time.only_line() {
            Some(line) => {
                let speed = TAU / line.rate();
                newton(time, near, |n| (line.value(n), speed))
            }
            None => newton(time, near, |n| (self.time_at(n), self.speed_at(n))),
        }
    }
}

/// Newton's iteration for the revolutions after the time `time`, s, from the guess `near`. `time_and_speed`
/// gives the time that some revolutions take, s, and the speed at their end, rad/s.
#[inline(always)]
fn newton(time: f64, near: f64, time_and_speed: impl Fn(f64) -> (f64, f64)) -> f64 {
    let step_from = |n: f64| {
        let (here, speed) = time_and_speed(n);
        (time - here) * speed / TAU
    };
    let mut n = near + step_from(near);
    for _ in 0..MOST_NEWTON_STEPS {
        let step = step_from(n);
        if step.abs() <= ROUNDING * n.abs() || step.is_nan() {
            break;
        }
        n += step;
    }
    n
}

/// Most steps of Newton's iteration. From a guess within a turn it takes four.
const MOST_NEWTON_STEPS: usize = 12;
/// A step of the iteration below this part of the revolutions is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Converts the series in N of a function into its series in θ: divides the k-th coefficient by
/// (2π)^k.
pub fn per_radian(series: Series) -> Series {
    let mut scale = 1.0;
    series.map(|coefficient| {
        let scaled = coefficient * scale;
        scale /= TAU;
        scaled
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_speed_takes_time_in_proportion() {
        let law = SpindleLaw::constant(500.0 * TAU / 60.0);
        assert!((law.time_at(500.0) - 60.0).abs() < 1e-12);
        assert!((law.speed_at(17.3) - 500.0 * TAU / 60.0).abs() < 1e-12);
    }

    #[test]
    fn revolutions_at_a_time_are_those_whose_time_it_is() {
        let mut time = PiecewisePolynomial::new();
        time.push(4.0, [0.0, 0.1, 0.0, 0.002, -0.0003, 0.0]);
        time.push(6.0, [0.4512, 0.1192, -0.0048, 0.0, 0.0001, 0.0]);
        let law = SpindleLaw::from_time(time);
        for n in [0.0, 0.3, 3.9, 4.1, 9.7] {
            for guess in [n - 0.4, n, n + 0.3] {
                let found = law.revolutions_at(law.time_at(n), guess);
                assert!((found - n).abs() <= 1e-14 * n.max(1.0), "{found} for {n}");
            }
        }
    }

    /// One line goes a shorter way. A second line far away takes the usual one.
    #[test]
    fn a_line_gives_the_revolutions_that_any_law_gives() {
        let mut time = PiecewisePolynomial::new();
        time.push(1.375, [0.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
        time.push(1e9, [0.1375, 0.1192, 0.0, 0.0, 0.0, 0.0]);
        let [one, both] = [&time.pieces()[1..], time.pieces()].map(|pieces| {
            SpindleLaw::from_time(PiecewisePolynomial::from_pieces(
                pieces.to_vec(),
                time.end(),
            ))
        });
        for n in [1.5, 17.37, 4321.987, 99_999.01] {
            let guess = n + 0.3;
            let found =
                [&one, &both].map(|law| law.revolutions_at(law.time_at(n), guess).to_bits());
            assert_eq!(found[0], found[1], "{n}");
        }
        assert!(one.revolutions_at(1.0, f64::INFINITY).is_nan());
        let n = [0.3, 1.9, 2.7];
        let (mut times, mut speeds) = ([0.0; 3], [0.0; 3]);
        both.times_at(&n, &mut times);
        both.speeds_at(&n, &mut speeds);
        assert_eq!(times, n.map(|n| both.time_at(n)));
        assert_eq!(speeds, n.map(|n| both.speed_at(n)));
    }

    /// A node on a step of time keeps the bytes that a single step of Newton's iteration gives.
    #[test]
    fn a_constant_speed_takes_one_step() {
        let law = SpindleLaw::constant(52.3);
        for n in [0.25, 17.37, 4321.987, 99_999.01] {
            let time = (law.time_at(n) * 2500.0).round() / 2500.0;
            let once = n + (time - law.time_at(n)) * law.speed_at(n) / TAU;
            assert_eq!(law.revolutions_at(time, n), once);
        }
    }
}
