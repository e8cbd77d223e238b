//! Truncated power series of order 4, and the elementary functions on them.
//!
//! The recurrences are the usual ones of automatic differentiation (Griewank and Walther,
//! *Evaluating Derivatives*, 2nd ed., 2008, §13.2). A function f with f′ = g·a′ gives its
//! coefficients one after the other, exact up to rounding.
//!
//! The coefficients go through plain loops: adaptors of arrays are calls that copy whole series.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Scalar;
use crate::dual::{one_minus_square, tanh_slope};

/// The order of all series. It is the order of the derivative that bounds the error of a cubic
/// segment.
pub const ORDER: usize = 4;

/// The coefficients c_k of Σ c_k t^k for k = 0 to `ORDER`, which is 4. The k-th derivative is
/// k!·c_k.
pub type Series = [f64; ORDER + 1];

/// 1/k for the recurrences. The first element is never used.
const OVER: [f64; ORDER + 1] = [0.0, 1.0, 0.5, 1.0 / 3.0, 0.25];

/// A series Σ c_k t^k over any other number type, truncated after `N` coefficients: after order 4
/// unless another `N` is given, and `N` is 5 at the most.
///
/// A coefficient follows from those of its own order and below, by the same operations for every
/// `N`. So a series with fewer coefficients has the same bits as the beginning of a longer one.
///
/// ```
/// use turnpath_core::{Scalar, Taylor};
/// let t = Taylor([0.0, 1.0, 0.0, 0.0, 0.0]);
/// assert_eq!(t.exp().0, [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taylor<T, const N: usize = { ORDER + 1 }>(pub [T; N]);

impl<T: Scalar, const N: usize> Taylor<T, N> {
    /// The beginning of a series of plain numbers.
    #[inline(always)]
    pub fn from_series(series: Series) -> Self {
        let mut out = Self([T::constant(0.0); N]);
        for (out, c) in out.0.iter_mut().zip(series) {
            *out = T::constant(c);
        }
        out
    }

    /// Its sine and cosine, where those of the constant term are known.
    #[inline(always)]
    pub fn sin_cos_from(self, start: (T, T)) -> (Self, Self) {
        self.coupled(start, -1.0)
    }

    /// The coefficients k·c_k: those of t·d/dt.
    #[inline(always)]
    fn weighted(&self) -> [T; N] {
        let mut out = self.0;
        for (k, out) in out.iter_mut().enumerate() {
            *out = *out * k as f64;
        }
        out
    }

    /// The series with the constant term `value` whose derivative is `slope` times that of `self`.
    #[inline(always)]
    fn integrate(self, value: T, slope: Self) -> Self {
        let inner = self.weighted();
        let mut out = [value; N];
        for k in 1..N {
            out[k] = convolve(&inner, &slope.0, 1, k) * OVER[k];
        }
        Self(out)
    }

    /// The two functions s and c with s′ = c·a′ and c′ = sign·s·a′.
    #[inline(always)]
    fn coupled(self, start: (T, T), sign: f64) -> (Self, Self) {
        let inner = self.weighted();
        let (mut s, mut c) = ([start.0; N], [start.1; N]);
        for k in 1..N {
            s[k] = convolve(&inner, &c, 1, k) * OVER[k];
            c[k] = convolve(&inner, &s, 1, k) * (sign * OVER[k]);
        }
        (Self(s), Self(c))
    }

    /// The function with f′ = (w₀ + sign·(f² − f₀²))·a′, where w₀ is the function's slope at the
    /// start.
    #[inline(always)]
    fn riccati(self, start: T, slope: T, sign: f64) -> Self {
        let inner = self.weighted();
        let (mut f, mut w) = ([start; N], [slope; N]);
        for k in 1..N {
            f[k] = convolve(&inner, &w, 1, k) * OVER[k];
            w[k] = convolve(&f, &f, 0, k) * sign;
        }
        Self(f)
    }
}

/// Σ a_j·b_{k−j} for j from `first` to `k`.
#[inline(always)]
fn convolve<T: Scalar, const N: usize>(a: &[T; N], b: &[T; N], first: usize, k: usize) -> T {
    let mut sum = a[first] * b[k - first];
    for j in first + 1..k + 1 {
        sum = sum + a[j] * b[k - j];
    }
    sum
}

impl<T: Scalar, const N: usize> Add for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let mut out = self;
        for (out, other) in out.0.iter_mut().zip(&other.0) {
            *out = *out + *other;
        }
        out
    }
}

impl<T: Scalar, const N: usize> Sub for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let mut out = self;
        for (out, other) in out.0.iter_mut().zip(&other.0) {
            *out = *out - *other;
        }
        out
    }
}

impl<T: Scalar, const N: usize> Mul for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut out = self;
        for (k, out) in out.0.iter_mut().enumerate() {
            *out = convolve(&self.0, &other.0, 0, k);
        }
        out
    }
}

impl<T: Scalar, const N: usize> Div for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let scale = other.0[0].recip();
        let mut out = [self.0[0] / other.0[0]; N];
        for k in 1..N {
            out[k] = (self.0[k] - convolve(&other.0, &out, 1, k)) * scale;
        }
        Self(out)
    }
}

impl<T: Scalar, const N: usize> Neg for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = self;
        for out in &mut out.0 {
            *out = -*out;
        }
        out
    }
}

impl<T: Scalar, const N: usize> Add<f64> for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: f64) -> Self {
        self.0[0] = self.0[0] + other;
        self
    }
}

impl<T: Scalar, const N: usize> Sub<f64> for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: f64) -> Self {
        self.0[0] = self.0[0] - other;
        self
    }
}

impl<T: Scalar, const N: usize> Mul<f64> for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        let mut out = self;
        for out in &mut out.0 {
            *out = *out * other;
        }
        out
    }
}

impl<T: Scalar, const N: usize> Div<f64> for Taylor<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        let mut out = self;
        for out in &mut out.0 {
            *out = *out / other;
        }
        out
    }
}

impl<T: Scalar, const N: usize> Scalar for Taylor<T, N> {
    type Mask = T::Mask;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        let mut out = [T::constant(0.0); N];
        out[0] = T::constant(value);
        Self(out)
    }

    #[inline(always)]
    fn less(self, other: Self) -> T::Mask {
        self.0[0].less(other.0[0])
    }

    #[inline(always)]
    fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        let mut out = no;
        for (out, yes) in out.0.iter_mut().zip(&yes.0) {
            *out = T::select(mask, *yes, *out);
        }
        out
    }

    #[inline(always)]
    fn floor(self) -> Self {
        let mut out = [T::constant(0.0); N];
        out[0] = self.0[0].floor();
        Self(out)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let value = self.0[0].recip();
        let mut out = [value; N];
        for k in 1..N {
            out[k] = -convolve(&self.0, &out, 1, k) * value;
        }
        Self(out)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.0[0].sqrt();
        let half = value.recip() * 0.5;
        let mut out = [value; N];
        for k in 1..N {
            let mut rest = self.0[k];
            for j in 1..k {
                rest = rest - out[j] * out[k - j];
            }
            out[k] = rest * half;
        }
        Self(out)
    }

    fn exp(self) -> Self {
        let inner = self.weighted();
        let mut out = [self.0[0].exp(); N];
        for k in 1..N {
            out[k] = convolve(&inner, &out, 1, k) * OVER[k];
        }
        Self(out)
    }

    fn ln(self) -> Self {
        self.integrate(self.0[0].ln(), self.recip())
    }

    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos_from(self.0[0].sin_cos())
    }

    fn tan(self) -> Self {
        let value = self.0[0].tan();
        self.riccati(value, value.squared() + 1.0, 1.0)
    }

    fn asin(self) -> Self {
        self.integrate(self.0[0].asin(), one_minus_square(self).sqrt().recip())
    }

    fn acos(self) -> Self {
        self.integrate(self.0[0].acos(), -one_minus_square(self).sqrt().recip())
    }

    fn atan(self) -> Self {
        self.integrate(self.0[0].atan(), (self.squared() + 1.0).recip())
    }

    fn atan2(self, x: Self) -> Self {
        let scale = (self.squared() + x.squared()).recip();
        let (dy, dx) = (self.weighted(), x.weighted());
        let mut turn = self;
        for (k, turn) in turn.0.iter_mut().enumerate() {
            *turn = convolve(&dy, &x.0, 0, k) - convolve(&dx, &self.0, 0, k);
        }
        let mut out = (turn * scale).0;
        out[0] = self.0[0].atan2(x.0[0]);
        for k in 1..N {
            out[k] = out[k] * OVER[k];
        }
        Self(out)
    }

    fn sinh_cosh(self) -> (Self, Self) {
        self.coupled(self.0[0].sinh_cosh(), 1.0)
    }

    fn tanh(self) -> Self {
        let value = self.0[0];
        self.riccati(value.tanh(), tanh_slope(value), -1.0)
    }

    fn powf(self, exponent: f64) -> Self {
        let scale = self.0[0].recip();
        let mut out = [self.0[0].powf(exponent); N];
        for k in 1..N {
            let mut sum = T::constant(0.0);
            for j in 1..k + 1 {
                let weight = exponent * j as f64 - (k - j) as f64;
                sum = sum + self.0[j] * out[k - j] * weight;
            }
            out[k] = sum * scale * OVER[k];
        }
        Self(out)
    }
}
