//! The spiral law ρ = ℓ(N) and the spindle law ω(N).

use std::f64::consts::TAU;

use crate::{PiecewisePolynomial, Series};

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

    /// The time t(N) in s as a piecewise polynomial.
    pub fn as_time(&self) -> &PiecewisePolynomial {
        &self.time
    }

    /// The time at which the spindle has made `n` revolutions, s.
    pub fn time_at(&self, n: f64) -> f64 {
        self.time.value(n)
    }

    /// The speed of the spindle after `n` revolutions, rad/s.
    pub fn speed_at(&self, n: f64) -> f64 {
        TAU / self.time.rate(n)
    }
}

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
}
