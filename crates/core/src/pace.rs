//! How the C angle runs in time around one place, and what that changes for the axes that follow it.

use crate::{Series, SpindleLaw, per_radian};

/// The C angle around one place of the path, as a series in time: θ − θ₀ = τ + a τ² + b τ³ + c τ⁴.
/// τ is the time in units in which the spindle makes one radian at the place, so that τ is the angle
/// itself where the speed is constant.
///
/// The controller's cubics run in time. C's own error e_C moves the angle at which the other axes
/// are compared, so the error that counts is e_Z − Z_θ·e_C − Z_X·e_X. What a linear part of Z makes
/// of e_C cancels in it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pace {
    second: f64,
    third: f64,
    fourth: f64,
}

impl Pace {
    /// The pace after the place `n`, in revolutions: at a knot that of the piece that begins there.
    pub fn after(spindle: &SpindleLaw, n: f64) -> Self {
        Self::of(spindle.as_time().series(n))
    }

    /// The pace before the place `n`: at a knot that of the piece that ends there.
    pub fn before(spindle: &SpindleLaw, n: f64) -> Self {
        Self::of(spindle.as_time().series_before(n))
    }

    /// Inverts the series of t in N.
    fn of(time: Series) -> Self {
        let [_, first, second, third, fourth] = per_radian(time);
        let [p, q, r] = [second / first, third / first, fourth / first];
        Self {
            second: -p,
            third: 2.0 * p * p - q,
            fourth: 5.0 * p * q - 5.0 * p * p * p - r,
        }
    }

    /// The series in τ of an axis whose series in θ this is, from the second coefficient on without
    /// what its slope makes of the angle's own: a cubic's error of the axis beside that of C.
    ///
    /// ```
    /// use turnpath_core::{Pace, SpindleLaw};
    /// let constant = Pace::after(&SpindleLaw::constant(50.0), 3.2);
    /// assert_eq!(constant.beside_c(&[1.0, 2.0, 3.0, 4.0, 5.0]), [1.0, 2.0, 3.0, 4.0, 5.0]);
    /// ```
    pub fn beside_c(&self, series: &Series) -> Series {
        let Self { second, third, .. } = *self;
        let [value, slope, c2, c3, c4] = *series;
        [
            value,
            slope,
            c2,
            2.0 * second * c2 + c3,
            (2.0 * third + second * second) * c2 + 3.0 * second * c3 + c4,
        ]
    }

    /// |d⁴θ/dτ⁴|: C's own error is this, times L⁴/384.
    pub fn fourth_of_c(&self) -> f64 {
        24.0 * self.fourth.abs()
    }

    /// |d³θ/dτ³| of this pace less that of another one.
    pub fn jump_of_c(&self, other: &Self) -> f64 {
        6.0 * (self.third - other.third).abs()
    }

    /// |dω/dθ|/ω: how much the speed changes on a radian, as a part of itself.
    pub fn change(&self) -> f64 {
        2.0 * self.second.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PiecewisePolynomial;

    /// t = N/4 + N²/50 − N³/90 + N⁴/200, against its inverse by Newton's iteration.
    #[test]
    fn the_angle_as_a_series_in_time_is_the_inverse_of_the_law() {
        let mut time = PiecewisePolynomial::new();
        time.push(3.0, [0.0, 0.25, 0.02, -1.0 / 90.0, 0.005, 0.0]);
        let law = SpindleLaw::from_time(time);
        let place = 0.7;
        let (pace, speed) = (Pace::after(&law, place), law.speed_at(place));
        for tau in [-0.2, -0.1, 0.1, 0.2_f64] {
            let n = law.revolutions_at(law.time_at(place) + tau / speed, place);
            let angle = std::f64::consts::TAU * (n - place);
            let square = tau * tau;
            let series = tau
                + pace.second * square
                + pace.third * square * tau
                + pace.fourth * square * square;
            assert!((angle - series).abs() < 0.2 * square * square * tau.abs());
            assert!((angle - tau).abs() > 5e-3 * square, "the speed changes");
        }
    }

    /// Z = θ³ in τ, less 3θ₀²·(θ − θ₀), by differences.
    #[test]
    fn a_cubic_beside_c_is_that_of_differences() {
        let pace = Pace {
            second: 0.05,
            third: -0.02,
            fourth: 0.01,
        };
        let found = pace.beside_c(&[0.0, 3.0, 3.0, 1.0, 0.0]);
        let beside = |tau: f64| {
            let square = tau * tau;
            let s = tau + 0.05 * square - 0.02 * square * tau + 0.01 * square * square;
            3.0 * s * s + s * s * s
        };
        let h: f64 = 1e-2;
        let fourth = (beside(2.0 * h) - 4.0 * beside(h) - 4.0 * beside(-h) + beside(-2.0 * h))
            / (h * h * h * h);
        assert!(
            (24.0 * found[4] - fourth).abs() < 1e-2,
            "{found:?} {fourth}"
        );
    }
}
