//! Quantities with units: converts the text of a recipe to inner units (mm, rad, 1/mm, rad/s,
//! mm/s²) and back.
//!
//! A decimal prefix moves the decimal point of the text before the text becomes a double. So `"100
//! nm"` is exactly the double `1e-4`, and `"1 in"` is exactly `25.4`.

use std::f64::consts::TAU;

use crate::decimal::Decimal;
use crate::table::{Scale, UNITS, Unit, find_unit, stands_for, tidy_unit, unit_like};
use crate::{Quantity, QuantityError};

impl Quantity {
    /// All quantities, in the order of the table of units.
    pub fn all() -> impl Iterator<Item = Self> {
        let is_first = |(at, unit): (usize, &Unit)| {
            let before = UNITS.iter().take(at);
            let mut of_its_kind = before.filter(|other| other.quantity == unit.quantity);
            of_its_kind.next().is_none().then_some(unit.quantity)
        };
        UNITS.iter().enumerate().filter_map(is_first)
    }

    /// The units of the quantity, the usual one first.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |unit| unit.quantity == self)
            .map(|unit| unit.symbol)
    }

    /// The units in which a recipe may write the quantity: its own, those of lengths for a feed, and
    /// those of rotation for a frequency.
    pub fn accepted_units(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |unit| stands_for(unit.quantity, self))
            .map(|unit| unit.symbol)
    }

    /// Reads a text such as `"5 mm"`, and returns the number in inner units.
    ///
    /// Lengths and quantities per length are the nearest double. Degrees are `x * DEG`, as the
    /// author of a strategy writes a default. So a recipe that writes out a default changes
    /// nothing.
    ///
    /// ```
    /// use turnpath_units::{DEG, Quantity};
    /// assert_eq!(Quantity::Length.parse("100 nm"), Ok(1e-4));
    /// assert_eq!(Quantity::Angle.parse("45 deg"), Ok(45.0 * DEG));
    /// assert_eq!(Quantity::PerLength.parse("0.08 /mm"), Ok(0.08));
    /// assert!(Quantity::Length.parse("8 ms").is_err());
    /// ```
    pub fn parse(self, text: &str) -> Result<f64, QuantityError> {
        let trimmed = text.trim();
        if unit_like::is_not_finite(trimmed) {
            return Err(QuantityError::NotFinite {
                text: trimmed.into(),
            });
        }
        let not_a_number = || QuantityError::NotANumber {
            text: trimmed.into(),
        };
        let (number, rest) = Decimal::take(trimmed).ok_or_else(not_a_number)?;
        let written = rest.trim();
        if unit_like::continues_a_number(written) {
            return Err(not_a_number());
        }
        let scale = self.scale_of(trimmed, written)?;
        let value = scale.apply(&number);
        if value.is_finite() {
            Ok(value)
        } else {
            Err(QuantityError::NotFinite {
                text: trimmed.into(),
            })
        }
    }

    fn scale_of(self, text: &str, written: &str) -> Result<Scale, QuantityError> {
        if written.is_empty() {
            return Err(QuantityError::NoUnit {
                text: text.into(),
                wanted: self,
            });
        }
        let tidy = tidy_unit(written);
        if let Some(unit) = find_unit(&tidy, self) {
            return Ok(unit.scale);
        }
        match UNITS.iter().find(|unit| unit.symbol == tidy) {
            Some(unit) => Err(QuantityError::OtherKind {
                text: text.into(),
                found: unit.quantity,
                wanted: self,
            }),
            None => Err(QuantityError::UnknownUnit {
                unit: written.into(),
                wanted: self,
                meant: unit_like::closest(&tidy, self),
            }),
        }
    }

    /// Writes a value in inner units, to 12 digits, in the unit that a person would choose.
    ///
    /// ```
    /// use turnpath_units::Quantity;
    /// assert_eq!(Quantity::Length.format(1e-4), "100 nm");
    /// assert_eq!(Quantity::Feed.format(0.01), "10 um/rev");
    /// ```
    pub fn format(self, value: f64) -> String {
        let symbol = self.unit_for(value.abs());
        let scale = find_unit(symbol, self).map_or(Scale::Shift(0), |unit| unit.scale);
        match scale.undo(value) {
            Some(number) => format!("{number} {symbol}"),
            None => format!("{} {symbol}", f64::INFINITY.copysign(value)),
        }
    }

    fn unit_for(self, size: f64) -> &'static str {
        match self {
            Self::Length if size == 0.0 => "mm",
            Self::Length if size < 1e-3 => "nm",
            Self::Length if size < 0.1 => "um",
            Self::Length if size < 1e4 => "mm",
            Self::Length => "m",
            Self::Feed if size == 0.0 => "mm/rev",
            Self::Feed if size < 1e-3 => "nm/rev",
            Self::Feed if size < 0.1 => "um/rev",
            Self::Feed => "mm/rev",
            Self::Angle if size > 0.0 && size < 1e-4 => "arcsec",
            Self::Angle => "deg",
            Self::PerLength => "/mm",
            Self::RotationSpeed => "rpm",
            Self::Frequency if size >= 1e3 * TAU => "kHz",
            Self::Frequency => "Hz",
            Self::Time => "s",
            Self::Velocity => "mm/s",
            Self::Acceleration if size < 1e3 => "mm/s^2",
            Self::Acceleration => "m/s^2",
            Self::Jerk if size < 1e3 => "mm/s^3",
            Self::Jerk => "m/s^3",
            Self::AngularAcceleration => "rad/s^2",
            Self::AngularJerk => "rad/s^3",
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::DEG;

    fn unknown(text: &str, wanted: Quantity) -> (String, Option<&'static str>) {
        match wanted.parse(text) {
            Err(QuantityError::UnknownUnit { unit, meant, .. }) => (unit, meant),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn lengths_are_the_nearest_double() {
        for (text, mm) in [
            ("100 nm", 1e-4),
            ("0.1 um", 1e-4),
            ("0.1 µm", 1e-4),
            ("0.1 μm", 1e-4),
            ("1e2 nm", 1e-4),
            ("5 mm", 5.0),
            ("5mm", 5.0),
            ("+.5 cm", 5.0),
            ("1. m", 1000.0),
            ("1 in", 25.4),
            ("0.1 in", 2.54),
            ("-3 um", -0.003),
            ("\u{2212}3 um", -0.003),
            ("0.3 um", 0.0003),
            ("1E-400 m", 0.0),
        ] {
            assert_eq!(Quantity::Length.parse(text), Ok(mm), "{text}");
        }
    }

    #[test]
    fn every_whole_count_of_nanometres_equals_its_decimal_in_millimetres() {
        for nm in 1..5000 {
            let mm: f64 = format!("{nm}e-6").parse().unwrap();
            assert_eq!(Quantity::Length.parse(&format!("{nm} nm")), Ok(mm));
        }
    }

    #[test]
    fn other_kinds_convert() {
        let close = |value: Result<f64, QuantityError>, wanted: f64| {
            let value = value.unwrap();
            assert!(
                (value - wanted).abs() <= 1e-15 * wanted.abs(),
                "{value} {wanted}"
            );
        };
        close(Quantity::Angle.parse("180 deg"), PI);
        close(Quantity::Angle.parse("60 arcmin"), DEG);
        close(Quantity::Angle.parse("3600 arcsec"), DEG);
        assert_eq!(Quantity::Angle.parse("100 mrad"), Ok(0.1));
        assert_eq!(Quantity::Angle.parse("1 rad"), Ok(1.0));
        for text in [
            "0.08 /mm",
            "0.08/mm",
            "0.08 1/mm",
            "0.08 mm^-1",
            "80 /m",
            "0.00008 /um",
        ] {
            assert_eq!(Quantity::PerLength.parse(text), Ok(0.08), "{text}");
        }
        close(Quantity::PerLength.parse("25.4 /in"), 1.0);
        for text in ["10 um/rev", "10 um", "0.01 mm / rev", "10000 nm"] {
            assert_eq!(Quantity::Feed.parse(text), Ok(0.01), "{text}");
        }
        close(Quantity::RotationSpeed.parse("60 rpm"), TAU);
        close(Quantity::RotationSpeed.parse("1 Hz"), TAU);
        close(Quantity::RotationSpeed.parse("1 rev/s"), TAU);
        assert_eq!(Quantity::RotationSpeed.parse("2 rad/s"), Ok(2.0));
        for text in ["70 Hz", "0.07 kHz", "4200 rpm", "70 rev/s"] {
            close(Quantity::Frequency.parse(text), 70.0 * TAU);
        }
        assert!(Quantity::RotationSpeed.parse("1 kHz").is_err());
    }

    #[test]
    fn what_an_axis_does_converts_with_signs_and_with_powers_as_people_write_them() {
        for (text, quantity, inner) in [
            ("3000 mm/min", Quantity::Velocity, 50.0),
            ("0.5 m/s^2", Quantity::Acceleration, 500.0),
            ("0.5 m/s²", Quantity::Acceleration, 500.0),
            ("500 mm/s²", Quantity::Acceleration, 500.0),
            ("500000 µm / s^2", Quantity::Acceleration, 500.0),
            ("1 g", Quantity::Acceleration, 9806.65),
            ("0.2 m/s³", Quantity::Jerk, 200.0),
            ("200 mm/s^3", Quantity::Jerk, 200.0),
            ("200 mm/s³", Quantity::Jerk, 200.0),
            ("2 rad/s²", Quantity::AngularAcceleration, 2.0),
            ("90 deg/s^2", Quantity::AngularAcceleration, 90.0 * DEG),
            ("60 rpm/s", Quantity::AngularAcceleration, 60.0 * TAU / 60.0),
            ("2 rad/s^3", Quantity::AngularJerk, 2.0),
            ("90 deg/s³", Quantity::AngularJerk, 90.0 * DEG),
        ] {
            assert_eq!(quantity.parse(text), Ok(inner), "{text}");
        }
        assert_eq!(Quantity::Acceleration.format(500.0), "500 mm/s^2");
        assert_eq!(Quantity::Acceleration.format(1500.0), "1.5 m/s^2");
        assert_eq!(Quantity::Jerk.format(2e5), "200 m/s^3");
        assert_eq!(Quantity::Jerk.format(2.5), "2.5 mm/s^3");
        assert_eq!(Quantity::AngularAcceleration.format(2.0), "2 rad/s^2");
        assert_eq!(unknown("5 mm/s2", Quantity::Acceleration).1, Some("mm/s^2"));
        assert_eq!(unknown("5 G", Quantity::Acceleration).1, Some("g"));
        assert_eq!(unknown("5 mm/s4", Quantity::Jerk).1, None);
        let power = Quantity::Acceleration.parse("5 mm/s");
        let found = Quantity::Velocity;
        assert!(matches!(power, Err(QuantityError::OtherKind { found: f, .. }) if f == found));
    }

    #[test]
    fn half_a_turn_is_not_above_pi() {
        assert_eq!(Quantity::Angle.parse("180 deg"), Ok(PI));
        assert_eq!(Quantity::Angle.parse("45 deg"), Ok(45.0 * DEG));
    }

    #[test]
    fn each_mistake_is_told_apart() {
        use QuantityError as E;
        let length = Quantity::Length;
        assert!(matches!(length.parse("5"), Err(E::NoUnit { .. })));
        for text in [
            "", "mm", "five mm", "1.2.3 mm", "5,5 mm", "1 000 mm", "- 3 mm",
        ] {
            assert!(
                matches!(length.parse(text), Err(E::NotANumber { .. })),
                "{text}"
            );
        }
        for text in ["inf mm", "-inf", "NaN mm", "1e400 mm", "infinity"] {
            assert!(
                matches!(length.parse(text), Err(E::NotFinite { .. })),
                "{text}"
            );
        }
        for (text, kind) in [
            ("8 ms", Quantity::Time),
            ("8 deg", Quantity::Angle),
            ("8 um/rev", Quantity::Feed),
            ("8 rpm", Quantity::RotationSpeed),
            ("8 /mm", Quantity::PerLength),
            ("8 mm/min", Quantity::Velocity),
        ] {
            match length.parse(text) {
                Err(E::OtherKind { found, .. }) => assert_eq!(found, kind, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn unknown_units_get_a_guess() {
        assert_eq!(
            unknown("5 mmm", Quantity::Length),
            ("mmm".into(), Some("mm"))
        );
        assert_eq!(unknown("5 MM", Quantity::Length).1, Some("mm"));
        assert_eq!(unknown("5 microns", Quantity::Length).1, Some("um"));
        assert_eq!(unknown("5 millimetres", Quantity::Length).1, Some("mm"));
        assert_eq!(unknown("5 °", Quantity::Angle).1, Some("deg"));
        assert_eq!(unknown("5 degrees", Quantity::Angle).1, Some("deg"));
        assert_eq!(unknown("5 RPM", Quantity::RotationSpeed).1, Some("rpm"));
        assert_eq!(unknown("5 parsec", Quantity::Length).1, None);
    }

    #[test]
    fn values_are_written_as_a_person_would() {
        for text in [
            "100 nm", "2.5 mm", "50 um", "0.5 mm", "0 mm", "12.5 m", "-3 um",
        ] {
            let value = Quantity::Length.parse(text).unwrap();
            assert_eq!(Quantity::Length.format(value), text);
        }
        assert_eq!(Quantity::Angle.format(45.0 * DEG), "45 deg");
        assert_eq!(Quantity::Angle.format(2.0 * DEG / 3600.0), "2 arcsec");
        assert_eq!(
            Quantity::RotationSpeed.format(500.0 * TAU / 60.0),
            "500 rpm"
        );
        assert_eq!(Quantity::Frequency.format(70.0 * TAU), "70 Hz");
        assert_eq!(Quantity::Frequency.format(1500.0 * TAU), "1.5 kHz");
        assert_eq!(Quantity::PerLength.format(0.08), "0.08 /mm");
        assert_eq!(Quantity::Feed.format(0.01), "10 um/rev");
        assert_eq!(Quantity::Length.format(1e-30), "1e-24 nm");
        assert_eq!(Quantity::Length.format(f64::INFINITY), "inf m");
    }

    #[test]
    fn what_is_written_reads_back() {
        let mut value = 1.234_567_89e-9;
        while value < 1e9 {
            for quantity in [
                Quantity::Length,
                Quantity::Feed,
                Quantity::PerLength,
                Quantity::Acceleration,
                Quantity::Jerk,
            ] {
                assert_eq!(quantity.parse(&quantity.format(value)), Ok(value));
            }
            let angle = Quantity::Angle
                .parse(&Quantity::Angle.format(value))
                .unwrap();
            assert!((angle - value).abs() < 1e-11 * value);
            value = format!("{:.8e}", value * 7.3).parse().unwrap();
        }
    }
}
