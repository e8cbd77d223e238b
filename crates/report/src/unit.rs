//! The units that numbers have in files.
//!
//! The model holds mm, rad and s. Each module here is for `#[serde(with = "…")]` on a number, an
//! optional number or several of them: the file holds the number in the module's unit, and the key
//! that the number is renamed to ends in that unit. A number that is not finite is `null` in a
//! file, and not a number when it is read.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Digits of a number in a file, after the first. Fifteen digits in all go through a double and
/// back unchanged; one more would let a conversion of units change the last.
const DIGITS: usize = 14;

/// A number as a file holds it: rounded to fifteen digits, so that a report which was read is
/// written as the same text.
pub fn rounded(value: f64) -> f64 {
    if !value.is_finite() {
        return value;
    }
    format!("{value:.DIGITS$e}").parse().unwrap_or(value)
}

/// What can be written in another unit: a number, or a number that may be missing.
pub trait InUnit: Sized {
    /// The form of the file.
    type FileValue: Serialize + for<'de> Deserialize<'de>;
    /// The value in units of which `per` make one of the model's.
    fn to_file(&self, per: f64) -> Self::FileValue;
    /// The value in the model's unit.
    fn from_file(value: Self::FileValue, per: f64) -> Self;
}

impl InUnit for f64 {
    type FileValue = Option<f64>;

    fn to_file(&self, per: f64) -> Option<f64> {
        let value = rounded(self * per);
        value.is_finite().then_some(value)
    }

    fn from_file(value: Option<f64>, per: f64) -> Self {
        value.map_or(f64::NAN, |number| number / per)
    }
}

impl InUnit for Option<f64> {
    type FileValue = Option<f64>;

    fn to_file(&self, per: f64) -> Option<f64> {
        self.and_then(|value| value.to_file(per))
    }

    fn from_file(value: Option<f64>, per: f64) -> Self {
        value.map(|number| number / per)
    }
}

macro_rules! units {
    ($($(#[$doc:meta])* $name:ident = $per:expr;)*) => {$(
        $(#[$doc])*
        pub mod $name {
            use super::*;

            /// How many of this unit make one of the model's.
            pub const PER: f64 = $per;

            /// Writes a number in this unit.
            ///
            /// # Errors
            /// When the format refuses.
            pub fn serialize<T: InUnit, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
                value.to_file(PER).serialize(to)
            }

            /// Reads a number in this unit.
            ///
            /// # Errors
            /// When there is none.
            pub fn deserialize<'de, T: InUnit, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
                Ok(T::from_file(T::FileValue::deserialize(from)?, PER))
            }
        }
    )*};
}

units! {
    /// Nanometres, of mm.
    nm = 1e6;
    /// Micrometres, of mm.
    um = 1e3;
    /// Millimetres; 1/mm, mm³ and other powers of mm too.
    mm = 1.0;
    /// Seconds; powers of seconds with mm too.
    s = 1.0;
    /// A pure number.
    one = 1.0;
    /// Degrees, of rad.
    deg = 180.0 / std::f64::consts::PI;
    /// Seconds of arc, of rad.
    arcsec = 648_000.0 / std::f64::consts::PI;
    /// Microradians, of rad.
    urad = 1e6;
    /// Revolutions a minute, of rad/s.
    rpm = 30.0 / std::f64::consts::PI;
    /// Per cent, of a part of the whole.
    percent = 100.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize, Deserialize)]
    struct Sample {
        #[serde(rename = "height_nm", with = "nm")]
        height: f64,
        #[serde(rename = "angle_deg", with = "deg")]
        angle: Option<f64>,
    }

    fn text(height: f64, angle: Option<f64>) -> String {
        serde_json::to_string(&Sample { height, angle }).unwrap()
    }

    #[test]
    fn a_key_has_its_unit_and_a_missing_number_is_null() {
        assert_eq!(text(1e-4, None), r#"{"height_nm":100.0,"angle_deg":null}"#);
        let half_turn = text(f64::INFINITY, Some(std::f64::consts::PI));
        assert_eq!(half_turn, r#"{"height_nm":null,"angle_deg":180.0}"#);
    }

    #[test]
    fn a_number_that_is_null_is_no_number() {
        let sample: Sample =
            serde_json::from_str(r#"{"height_nm":null,"angle_deg":null}"#).unwrap();
        assert!(sample.height.is_nan() && sample.angle.is_none());
    }

    /// Numbers of all sizes with digits all over, by a linear congruence.
    #[test]
    fn numbers_that_were_read_are_written_as_the_same_text() {
        let mut state: u64 = 7;
        for _ in 0..20_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let mantissa = 1.0 + (state >> 12) as f64 / (1u64 << 52) as f64;
            let scale: f64 = format!("1e{}", (state % 41) as i32 - 20).parse().unwrap();
            let height = mantissa * scale;
            let first = text(height, Some(height));
            let sample: Sample = serde_json::from_str(&first).unwrap();
            let second = serde_json::to_string(&sample).unwrap();
            assert_eq!(first, second);
            let again: Sample = serde_json::from_str(&second).unwrap();
            assert_eq!((sample.height, sample.angle), (again.height, again.angle));
        }
    }
}
