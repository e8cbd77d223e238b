//! Arrays of numbers in a report: for pictures, which need no more digits than an `f32` has.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::unit::InUnit;

/// The type of the numbers in a file: little-endian `f32`, by the name that numpy and plotly have
/// for it.
const F4: &str = "f4";
/// Bytes of a number in a file.
const BYTES: usize = size_of::<f32>();

/// Numbers in a row. A file holds them as `f32` in base64, `{"dtype": "f4", "bdata": "…"}`; a number
/// that is not there is not a number in both.
#[derive(Debug, Clone, Default)]
pub struct Samples(pub Vec<f64>);

/// The form of a file.
#[derive(Debug, Clone)]
pub struct FileSamples(Vec<f32>);

#[derive(Serialize, Deserialize)]
struct EncodedSamples {
    dtype: String,
    bdata: String,
}

impl Samples {
    /// The smallest and the largest number; `None` without any.
    pub fn range(&self) -> Option<(f64, f64)> {
        let mut known = self.0.iter().copied().filter(|value| value.is_finite());
        let first = known.next()?;
        let wider = |(least, most): (f64, f64), value: f64| (least.min(value), most.max(value));
        Some(known.fold((first, first), wider))
    }
}

/// Numbers that are not there are alike.
impl PartialEq for Samples {
    fn eq(&self, other: &Self) -> bool {
        let same = |(one, other): (&f64, &f64)| one == other || (one.is_nan() && other.is_nan());
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(same)
    }
}

impl FromIterator<f64> for Samples {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl InUnit for Samples {
    type FileValue = FileSamples;

    fn to_file(&self, per: f64) -> FileSamples {
        FileSamples(self.0.iter().map(|value| (value * per) as f32).collect())
    }

    fn from_file(value: FileSamples, per: f64) -> Self {
        value
            .0
            .iter()
            .map(|value| f64::from(*value) / per)
            .collect()
    }
}

impl Serialize for FileSamples {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self
            .0
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        EncodedSamples {
            dtype: F4.to_owned(),
            bdata: STANDARD.encode(bytes),
        }
        .serialize(to)
    }
}

impl<'de> Deserialize<'de> for FileSamples {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let EncodedSamples { dtype, bdata } = EncodedSamples::deserialize(from)?;
        if dtype != F4 {
            return Err(D::Error::custom(format!("`{dtype}` is not {F4}")));
        }
        let bytes = STANDARD.decode(bdata).map_err(D::Error::custom)?;
        let (numbers, rest) = bytes.as_chunks::<BYTES>();
        if !rest.is_empty() {
            return Err(D::Error::custom("a number of the array is cut off"));
        }
        Ok(Self(
            numbers
                .iter()
                .map(|number| f32::from_le_bytes(*number))
                .collect(),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::unit;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Heights {
        #[serde(rename = "height_nm", with = "unit::nm")]
        height: Samples,
    }

    #[test]
    fn numbers_are_f32_in_base64_in_the_unit_of_their_key() {
        let heights = Heights {
            height: Samples(vec![1e-6, -2e-6]),
        };
        // 1.0f32 is 00 00 80 3f, −2.0f32 is 00 00 00 c0.
        let text = r#"{"height_nm":{"dtype":"f4","bdata":"AACAPwAAAMA="}}"#;
        assert_eq!(serde_json::to_string(&heights).unwrap(), text);
    }

    #[test]
    fn what_was_read_is_written_as_the_same_text() {
        let values = (0..5000).map(|i| f64::from(i).sin() * 1e-4 / f64::from(i + 1));
        let heights = Heights {
            height: values.chain([f64::NAN]).collect(),
        };
        let text = serde_json::to_string(&heights).unwrap();
        let read: Heights = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        let again: Heights = serde_json::from_str(&text).unwrap();
        assert_eq!(read, again);
    }

    #[test]
    fn damaged_arrays_are_refused() {
        for (array, why) in [
            (r#"{"dtype":"f8","bdata":""}"#, "`f8` is not f4"),
            (r#"{"dtype":"f4","bdata":"AACA"}"#, "cut off"),
            (r#"{"dtype":"f4","bdata":"?"}"#, "Invalid symbol"),
        ] {
            let text = format!(r#"{{"height_nm":{array}}}"#);
            let error = serde_json::from_str::<Heights>(&text).unwrap_err();
            assert!(error.to_string().contains(why), "{error}");
        }
    }

    #[test]
    fn the_range_leaves_out_what_is_no_number() {
        let samples = Samples(vec![f64::NAN, 2.0, -1.0, f64::INFINITY]);
        assert_eq!(samples.range(), Some((-1.0, 2.0)));
        assert_eq!(Samples(vec![f64::NAN]).range(), None);
    }
}
