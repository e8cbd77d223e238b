//! Reports as JSON text.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The form of reports as JSON. It grows when a key changes its name or its meaning.
pub const FORMAT: u32 = 2;

/// A report as JSON text, with a line end.
pub fn to_json(report: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(report).unwrap_or_else(|error| error.to_string());
    text.push('\n');
    escaped(text)
}

/// The text with the control characters escaped that JSON allows in texts and a terminal obeys.
fn escaped(text: String) -> String {
    let must_be = |c: char| c.is_control() && c != '\n';
    if !text.contains(must_be) {
        return text;
    }
    let escape = |c: char| match must_be(c) {
        true => format!("\\u{:04x}", u32::from(c)),
        false => c.to_string(),
    };
    text.chars().map(escape).collect()
}

/// Why a JSON text is no report.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// It is no JSON, or not that of such a report.
    #[error("it is not the JSON of such a report")]
    Json(#[from] serde_json::Error),
    /// It has another form.
    #[error(
        "its form is {}, but this version of turnpath reads form {FORMAT}; make it again",
        found.map_or("1 or older".to_owned(), |form| form.to_string())
    )]
    OtherForm {
        /// Its form; form 1 has no number.
        found: Option<u32>,
    },
}

/// The one key that all forms have.
#[derive(Deserialize)]
struct Form {
    format: Option<u32>,
}

/// A report from JSON text.
///
/// # Errors
/// When the text is no JSON, is not that of such a report, or has another [`FORMAT`].
pub fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, FormatError> {
    let Form { format } = serde_json::from_str(text)?;
    match format {
        Some(FORMAT) => Ok(serde_json::from_str(text)?),
        found => Err(FormatError::OtherForm { found }),
    }
}

/// The report with every number rounded as files hold it.
pub(crate) fn rounded_for_files<T: Serialize + DeserializeOwned>(report: T) -> T {
    let rounded = serde_json::to_value(&report).and_then(serde_json::from_value);
    rounded.unwrap_or(report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::RunReport;
    use crate::sample::SUMMARY;

    fn refusal(text: &str) -> String {
        from_json::<RunReport>(text).unwrap_err().to_string()
    }

    #[test]
    fn a_real_summary_is_read_and_written_as_the_same_text() {
        let report: RunReport = from_json(SUMMARY).unwrap();
        assert_eq!(to_json(&report), SUMMARY);
        assert!(report.verdict().holds());
    }

    #[test]
    fn control_characters_are_escaped_and_read_back() {
        let name = "a\u{1b}b\u{7f}c\u{9b}2J\n";
        let text = to_json(&name);
        assert_eq!(text, "\"a\\u001bb\\u007fc\\u009b2J\\n\"\n");
        let back: String = serde_json::from_str(&text).unwrap();
        assert_eq!(back, name);
    }

    #[test]
    fn another_form_is_refused_by_its_number_before_its_keys() {
        let newer = refusal(&SUMMARY.replacen("\"format\": 2", "\"format\": 3", 1));
        assert!(
            newer.contains("form is 3") && newer.contains("make it again"),
            "{newer}"
        );
        let older = refusal(&SUMMARY.replacen("\"format\": 2,", "", 1));
        assert!(older.contains("form is 1 or older"), "{older}");
        assert_eq!(refusal("[1, 2"), "it is not the JSON of such a report");
    }
}
