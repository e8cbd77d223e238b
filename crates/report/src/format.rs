//! Reports as JSON text.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// The form of reports as JSON. It grows when a key changes its name or its meaning.
pub const FORMAT: u32 = 2;

/// A report as JSON text, with a line end.
pub fn to_json(report: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(report).unwrap_or_else(|error| error.to_string());
    text.push('\n');
    text
}

/// A report from JSON text.
///
/// # Errors
/// When the text is no JSON, or not that of such a report.
pub fn from_json<T: DeserializeOwned>(text: &str) -> serde_json::Result<T> {
    serde_json::from_str(text)
}

/// The report with every number rounded as files hold it.
pub(crate) fn as_filed<T: Serialize + DeserializeOwned>(report: T) -> T {
    let filed = serde_json::to_value(&report).and_then(serde_json::from_value);
    filed.unwrap_or(report)
}
