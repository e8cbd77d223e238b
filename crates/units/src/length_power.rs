//! Powers of a length: `"5 mm"`, `"0.08 /mm"`, `"2 mm^2"`, `"1e-6 /mm^3"`; and angles, whose power
//! is 0.

use crate::decimal::Decimal;
use crate::{Quantity, QuantityError};

/// Largest exponent of a length. No asphere has a higher power.
const LARGEST_POWER: i32 = 40;

/// A number in a power of mm, or in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthPower {
    /// The number.
    pub value: f64,
    /// The power: 1 for a length, −1 for a quantity per length, 0 for an angle.
    pub power: i32,
}

impl LengthPower {
    /// Reads a length, a quantity per length, a whole power of these, or an angle.
    ///
    /// ```
    /// use turnpath_units::LengthPower;
    /// let term = LengthPower::parse("1e-6 /um^3").unwrap();
    /// assert_eq!((term.value, term.power), (1e3, -3));
    /// assert!(LengthPower::parse("5 rpm").is_err());
    /// ```
    ///
    /// # Errors
    /// For every other text, that of reading it as a length.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        if let Some(power) = Self::of_power(text.trim()) {
            return Ok(power);
        }
        let kinds = [
            (Quantity::Length, 1),
            (Quantity::PerLength, -1),
            (Quantity::Angle, 0),
        ];
        let read = |(kind, power): (Quantity, i32)| {
            let value = kind.parse(text).ok()?;
            Some(Self { value, power })
        };
        match kinds.into_iter().find_map(read) {
            Some(power) => Ok(power),
            None => Quantity::Length
                .parse(text)
                .map(|value| Self { value, power: 1 }),
        }
    }

    /// A number with an exponent at its unit.
    fn of_power(text: &str) -> Option<Self> {
        let (base, exponent) = text.rsplit_once('^')?;
        let exponent: i32 = exponent.trim().parse().ok()?;
        if !(1..=LARGEST_POWER).contains(&exponent) {
            return None;
        }
        let (_, unit) = Decimal::take(base)?;
        let (kind, sign) = match unit.trim().starts_with(['/', '1']) {
            true => (Quantity::PerLength, -1),
            false => (Quantity::Length, 1),
        };
        let one = kind.parse(&format!("1 {}", unit.trim())).ok()?;
        let mut value = kind.parse(base).ok()?;
        for _ in 1..exponent {
            value *= one;
        }
        let power = sign * exponent;
        value.is_finite().then_some(Self { value, power })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<(f64, i32)> {
        let read = LengthPower::parse(text).ok()?;
        Some((read.value, read.power))
    }

    #[test]
    fn powers_are_in_mm() {
        assert_eq!(read("5 um"), Some((5e-3, 1)));
        assert_eq!(read("0.08 /mm"), Some((0.08, -1)));
        assert_eq!(read("2 mm^2"), Some((2.0, 2)));
        assert_eq!(read("3 m^2"), Some((3e6, 2)));
        assert_eq!(read("1e-6 /mm^3"), Some((1e-6, -3)));
        assert_eq!(read("180 deg"), Some((std::f64::consts::PI, 0)));
    }

    #[test]
    fn other_units_and_powers_are_refused() {
        for text in [
            "5",
            "5 rpm",
            "5 mm^0",
            "5 mm^41",
            "5 mm^1.5",
            "mm^2",
            "5 deg^2",
            "1e300 m^40",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
