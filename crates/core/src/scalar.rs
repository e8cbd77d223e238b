//! The number that a surface formula is written in.
//!
//! A formula is written once over [`Scalar`]. It gives its value (`f64`), many values at a time
//! ([`Lanes`](crate::Lanes)), its gradient ([`Dual`](crate::Dual)), its derivatives along a curve
//! ([`Taylor`](crate::Taylor)), and the derivatives of its gradient (`Taylor<Dual<f64>>`).
//!
//! Elementary functions come from the crate `libm`, and not from the standard library. The results of
//! the standard library depend on the CPU, and the same recipe must give the same bytes everywhere. The
//! square root and [`Scalar::floor`] are the standard library's, since they are exact everywhere.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The result of a comparison: one truth value, or one for each lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Whether the mask is true in every lane.
    fn all(self) -> bool;
    /// Whether the mask is true in some lane.
    fn any(self) -> bool;
}

impl Mask for bool {
    fn all(self) -> bool {
        self
    }

    fn any(self) -> bool {
        self
    }
}

/// A number type with the arithmetic and the elementary functions that surfaces need.
///
/// Comparisons use the value alone, never the derivatives. A formula chooses with
/// [`Scalar::select`] instead of `if`, because lanes may differ.
///
/// ```
/// use turnpath_core::{Dual, Scalar};
/// fn sag<S: Scalar>(x: S, y: S) -> S {
///     x.squared() * 0.1 + (y * 2.0).sin()
/// }
/// assert_eq!(sag(1.0, 0.0), 0.1);
/// let z = sag(Dual::variable_x(1.0), Dual::variable_y(0.0));
/// assert_eq!((z.value, z.dx, z.dy), (0.1, 0.2, 2.0));
/// ```
pub trait Scalar:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The result of a comparison.
    type Mask: Mask;

    /// A constant: its derivatives are zero, and it is the same in all lanes.
    fn constant(value: f64) -> Self;
    /// `self < other`, by value.
    fn less(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The largest whole number that is not above the value. Its derivatives are zero.
    fn floor(self) -> Self;
    /// 1 / self.
    fn recip(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Tangent.
    fn tan(self) -> Self;
    /// Arc sine.
    fn asin(self) -> Self;
    /// Arc cosine.
    fn acos(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// The angle of the point (x, self), −π to π.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine and cosine.
    fn sinh_cosh(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// A real power of a positive number.
    fn powf(self, exponent: f64) -> Self;

    /// An integer power, by repeated squaring. The derivatives are exact at zero too.
    fn powi(self, exponent: i32) -> Self {
        let mut left = exponent.unsigned_abs();
        let mut square = self;
        let mut power = Self::constant(1.0);
        while left > 0 {
            if left & 1 == 1 {
                power = power * square;
            }
            left >>= 1;
            if left > 0 {
                square = square * square;
            }
        }
        if exponent < 0 { power.recip() } else { power }
    }

    /// self · self.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }

    /// Sine.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Hyperbolic sine.
    fn sinh(self) -> Self {
        self.sinh_cosh().0
    }

    /// Hyperbolic cosine.
    fn cosh(self) -> Self {
        self.sinh_cosh().1
    }

    /// sqrt(self² + other²). Like `sqrt`, it has no derivatives at the origin.
    fn hypot(self, other: Self) -> Self {
        (self.squared() + other.squared()).sqrt()
    }

    /// Absolute value. At zero the derivatives are those of `self`.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.less(Self::constant(0.0)), -self, self)
    }

    /// The smaller one, by value.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }

    /// The larger one, by value.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }
}

/// The functions come from `libm`, except for the square root and `floor`, which are exact everywhere.
impl Scalar for f64 {
    type Mask = bool;

    fn constant(value: f64) -> Self {
        value
    }

    fn less(self, other: Self) -> bool {
        self < other
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    fn recip(self) -> Self {
        1.0 / self
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn exp(self) -> Self {
        libm::exp(self)
    }

    fn ln(self) -> Self {
        libm::log(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }

    fn tan(self) -> Self {
        libm::tan(self)
    }

    fn asin(self) -> Self {
        libm::asin(self)
    }

    fn acos(self) -> Self {
        libm::acos(self)
    }

    fn atan(self) -> Self {
        libm::atan(self)
    }

    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }

    fn sinh_cosh(self) -> (Self, Self) {
        (libm::sinh(self), libm::cosh(self))
    }

    fn tanh(self) -> Self {
        libm::tanh(self)
    }

    fn powf(self, exponent: f64) -> Self {
        libm::pow(self, exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::Scalar;

    #[test]
    fn floor_has_the_bits_of_libm() {
        let edges = [
            0.0,
            0.5,
            1.0,
            1.5,
            4_503_599_627_370_495.5,
            9_007_199_254_740_992.0,
        ];
        let tiny = [
            f64::MIN_POSITIVE,
            5e-324,
            f64::INFINITY,
            f64::MAX,
            1.0 - f64::EPSILON,
        ];
        for value in edges
            .into_iter()
            .chain(tiny)
            .flat_map(|value| [value, -value])
        {
            assert_eq!(
                Scalar::floor(value).to_bits(),
                libm::floor(value).to_bits(),
                "{value}"
            );
        }
        assert!(Scalar::floor(f64::NAN).is_nan());
    }
}
