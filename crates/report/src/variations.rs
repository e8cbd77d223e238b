//! The keys that vary in a run and their values, in a report's files: `{"feed": "constant"}`.
//!
//! For `#[serde(with = "variations")]`.

use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serializer};

/// Writes the pairs as one object, in their order.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer>(pairs: &[(String, String)], to: S) -> Result<S::Ok, S::Error> {
    let mut map = to.serialize_map(Some(pairs.len()))?;
    for (key, value) in pairs {
        map.serialize_entry(key, value)?;
    }
    map.end()
}

/// Reads the object.
///
/// # Errors
/// When it is none.
pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(String, String)>, D::Error> {
    let map = serde_json::Map::<String, serde_json::Value>::deserialize(from)?;
    let text = |value: serde_json::Value| match value {
        serde_json::Value::String(text) => text,
        other => other.to_string(),
    };
    Ok(map
        .into_iter()
        .map(|(key, value)| (key, text(value)))
        .collect())
}
