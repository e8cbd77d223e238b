//! The dimension of a value: which power of a length it is.

use std::fmt;

/// Powers that are closer than this are the same. It is far above the rounding of 1/3 · 3.
const SAME: f64 = 1e-9;

/// A power of a length. Angles are pure numbers, as in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dimension {
    /// A zero, which can be of any dimension.
    Any,
    /// The power: 0 for a pure number, 1 for a length, −1 for a quantity per length.
    Power(f64),
}

impl Dimension {
    /// A pure number or an angle.
    pub const PURE: Self = Self::Power(0.0);
    /// A length.
    pub const LENGTH: Self = Self::Power(1.0);

    /// The dimension of a sum; `None` if the two cannot be added.
    pub fn common(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Any, dimension) | (dimension, Self::Any) => Some(dimension),
            (Self::Power(one), Self::Power(two)) => ((one - two).abs() < SAME).then_some(self),
        }
    }

    /// Whether it is that of a pure number.
    pub fn is_pure(self) -> bool {
        self.common(Self::PURE).is_some()
    }

    /// The dimension of a product. A product with zero is zero.
    pub fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::Power(one), Self::Power(two)) => Self::Power(one + two),
            _ => Self::Any,
        }
    }

    /// The dimension of a power.
    pub fn to(self, exponent: f64) -> Self {
        match self {
            Self::Any => Self::Any,
            Self::Power(power) => Self::Power(power * exponent),
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Power(power) = self else {
            return f.write_str("zero");
        };
        if self.is_pure() {
            f.write_str("a pure number")
        } else if self.common(Self::LENGTH).is_some() {
            f.write_str("a length")
        } else {
            write!(f, "a number of mm^{power}")
        }
    }
}
