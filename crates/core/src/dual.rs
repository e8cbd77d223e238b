//! Dual numbers: a value with its first derivatives with respect to x and y.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Scalar;

/// A value and its exact first derivatives.
///
/// ```
/// use turnpath_core::{Dual, Scalar};
/// let (x, y) = (Dual::variable_x(2.0), Dual::variable_y(8.0));
/// let mean = (x * y).sqrt();
/// assert_eq!((mean.value, mean.dx, mean.dy), (4.0, 1.0, 0.25));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<T> {
    /// The value.
    pub value: T,
    /// The derivative with respect to x.
    pub dx: T,
    /// The derivative with respect to y.
    pub dy: T,
}

impl<T: Scalar> Dual<T> {
    /// The variable x itself.
    #[inline(always)]
    pub fn variable_x(value: T) -> Self {
        Self {
            value,
            dx: T::constant(1.0),
            dy: T::constant(0.0),
        }
    }

    /// The variable y itself.
    #[inline(always)]
    pub fn variable_y(value: T) -> Self {
        Self {
            value,
            dx: T::constant(0.0),
            dy: T::constant(1.0),
        }
    }

    /// f(self), from the value of f and of f's derivative at `self`.
    #[inline(always)]
    fn chain(self, value: T, slope: T) -> Self {
        Self {
            value,
            dx: self.dx * slope,
            dy: self.dy * slope,
        }
    }

    #[inline(always)]
    fn with_value(self, value: T) -> Self {
        Self { value, ..self }
    }
}

impl<T: Scalar> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            dx: self.dx + other.dx,
            dy: self.dy + other.dy,
        }
    }
}

impl<T: Scalar> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            dx: self.dx - other.dx,
            dy: self.dy - other.dy,
        }
    }
}

impl<T: Scalar> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            dx: self.dx * other.value + self.value * other.dx,
            dy: self.dy * other.value + self.value * other.dy,
        }
    }
}

impl<T: Scalar> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let scale = other.value.recip();
        Self {
            value,
            dx: (self.dx - value * other.dx) * scale,
            dy: (self.dy - value * other.dy) * scale,
        }
    }
}

impl<T: Scalar> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            dx: -self.dx,
            dy: -self.dy,
        }
    }
}

impl<T: Scalar> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self.with_value(self.value + other)
    }
}

impl<T: Scalar> Sub<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        self.with_value(self.value - other)
    }
}

impl<T: Scalar> Mul<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self {
            value: self.value * other,
            dx: self.dx * other,
            dy: self.dy * other,
        }
    }
}

impl<T: Scalar> Div<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        Self {
            value: self.value / other,
            dx: self.dx / other,
            dy: self.dy / other,
        }
    }
}

impl<T: Scalar> Scalar for Dual<T> {
    type Mask = T::Mask;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        let zero = T::constant(0.0);
        Self {
            value: T::constant(value),
            dx: zero,
            dy: zero,
        }
    }

    #[inline(always)]
    fn less(self, other: Self) -> T::Mask {
        self.value.less(other.value)
    }

    #[inline(always)]
    fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self {
            value: T::select(mask, yes.value, no.value),
            dx: T::select(mask, yes.dx, no.dx),
            dy: T::select(mask, yes.dy, no.dy),
        }
    }

    #[inline(always)]
    fn floor(self) -> Self {
        let zero = T::constant(0.0);
        Self {
            value: self.value.floor(),
            dx: zero,
            dy: zero,
        }
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let value = self.value.recip();
        self.chain(value, -value.squared())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, value.recip() * 0.5)
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, value.squared() + 1.0)
    }

    fn asin(self) -> Self {
        self.chain(
            self.value.asin(),
            one_minus_square(self.value).sqrt().recip(),
        )
    }

    fn acos(self) -> Self {
        self.chain(
            self.value.acos(),
            -one_minus_square(self.value).sqrt().recip(),
        )
    }

    fn atan(self) -> Self {
        self.chain(self.value.atan(), (self.value.squared() + 1.0).recip())
    }

    fn atan2(self, x: Self) -> Self {
        let scale = (self.value.squared() + x.value.squared()).recip();
        Self {
            value: self.value.atan2(x.value),
            dx: (x.value * self.dx - self.value * x.dx) * scale,
            dy: (x.value * self.dy - self.value * x.dy) * scale,
        }
    }

    fn sinh_cosh(self) -> (Self, Self) {
        let (sinh, cosh) = self.value.sinh_cosh();
        (self.chain(sinh, cosh), self.chain(cosh, sinh))
    }

    fn tanh(self) -> Self {
        self.chain(self.value.tanh(), tanh_slope(self.value))
    }

    fn powf(self, exponent: f64) -> Self {
        let slope = self.value.powf(exponent - 1.0) * exponent;
        self.chain(self.value.powf(exponent), slope)
    }
}

/// 1 − u², without the cancellation near |u| = 1.
#[inline(always)]
pub(crate) fn one_minus_square<S: Scalar>(u: S) -> S {
    (-u + 1.0) * (u + 1.0)
}

/// The derivative of tanh u, which is sech² u = 4e/(1 + e)² with e = exp(−2|u|).
///
/// Nothing in it overflows, so it and its own derivatives are 0 far from 0, where cosh u is not
/// finite.
#[inline(always)]
pub(crate) fn tanh_slope<S: Scalar>(u: S) -> S {
    let decay = (u.abs() * -2.0).exp();
    decay * (decay + 1.0).recip().squared() * 4.0
}
