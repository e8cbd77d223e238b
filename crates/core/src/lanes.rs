//! Several numbers side by side, so that the compiler can use vector registers.

use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::{Mask, Scalar, sine};

/// So many lanes go through loops in wide registers. Functions of fewer are faster one by one.
const FULL: usize = 8;

/// `N` numbers that go through a formula together.
///
/// Each lane is bit for bit equal to what the formula gives for that number alone.
///
/// ```
/// use turnpath_core::{Lanes, Scalar};
/// let angles = Lanes([0.0, 0.5, 1.0, 1.5]);
/// assert_eq!(angles.sin().0[2], Scalar::sin(1.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const N: usize>(pub [f64; N]);

/// One truth value for each lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaneMask<const N: usize>(pub [bool; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(mut self, function: impl Fn(f64) -> f64) -> Self {
        for lane in &mut self.0 {
            *lane = function(*lane);
        }
        self
    }

    #[inline(always)]
    fn zip(mut self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        for (lane, other) in self.0.iter_mut().zip(&other.0) {
            *lane = function(*lane, *other);
        }
        self
    }

    /// Applies a function with two results to each lane.
    #[inline(always)]
    fn map_pair(self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        let mut pair = (self, self);
        for i in 0..N {
            (pair.0.0[i], pair.1.0[i]) = function(self.0[i]);
        }
        pair
    }
}

macro_rules! lanewise {
    ($($operation:ident $method:ident)*) => {$(
        impl<const N: usize> $operation for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, f64::$method)
            }
        }

        impl<const N: usize> $operation<f64> for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|lane| lane.$method(other))
            }
        }
    )*};
}

lanewise!(Add add Sub sub Mul mul Div div);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(f64::neg)
    }
}

impl<const N: usize> Scalar for Lanes<N> {
    type Mask = LaneMask<N>;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; N])
    }

    #[inline(always)]
    fn less(self, other: Self) -> LaneMask<N> {
        LaneMask(from_fn(|i| self.0[i] < other.0[i]))
    }

    #[inline(always)]
    fn select(mask: LaneMask<N>, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.map(Scalar::floor)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.map(Scalar::recip)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(Scalar::sqrt)
    }

    fn exp(self) -> Self {
        self.map(Scalar::exp)
    }

    fn ln(self) -> Self {
        self.map(Scalar::ln)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if N < FULL {
            return self.map_pair(Scalar::sin_cos);
        }
        let (sines, cosines) = sine::of_lanes(&self.0);
        (Self(sines), Self(cosines))
    }

    fn tan(self) -> Self {
        self.map(Scalar::tan)
    }

    fn asin(self) -> Self {
        self.map(Scalar::asin)
    }

    fn acos(self) -> Self {
        self.map(Scalar::acos)
    }

    fn atan(self) -> Self {
        self.map(Scalar::atan)
    }

    fn atan2(self, x: Self) -> Self {
        self.zip(x, Scalar::atan2)
    }

    fn sinh_cosh(self) -> (Self, Self) {
        self.map_pair(Scalar::sinh_cosh)
    }

    fn tanh(self) -> Self {
        self.map(Scalar::tanh)
    }

    fn powf(self, exponent: f64) -> Self {
        self.map(|lane| Scalar::powf(lane, exponent))
    }
}

impl<const N: usize> BitAnd for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
}

impl<const N: usize> BitOr for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
}

impl<const N: usize> Not for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}

impl<const N: usize> Mask for LaneMask<N> {
    fn all(self) -> bool {
        self.0.iter().all(|lane| *lane)
    }

    fn any(self) -> bool {
        self.0.iter().any(|lane| *lane)
    }
}
