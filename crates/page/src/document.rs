//! The frame of a page: policy, style, scripts and data in one file.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::html::escaped;

/// plotly.js, its bundle of Cartesian traces: MIT, see `assets/plotly.LICENSE`.
const PLOTLY: &str = include_str!("../assets/plotly-cartesian.min.js");
const SCRIPT: &str = include_str!("../assets/page.js");
const STYLE: &str = include_str!("../assets/page.css");
/// What every page begins with.
const MARK: &str = "<!DOCTYPE html>\n<html lang=\"en\" data-made-by=\"turnpath\">\n";

/// Whether a file begins as a page of turnpath does.
pub fn is_page(beginning: &[u8]) -> bool {
    beginning.starts_with(MARK.as_bytes())
}

/// A page with these data and this HTML in its body.
pub fn document(title: &str, body: &str, data: &impl Serialize) -> String {
    let policy = format!(
        "default-src 'none'; script-src {} {}; style-src 'unsafe-inline'; img-src data: blob:; \
         base-uri 'none'; form-action 'none'",
        hash(PLOTLY),
        hash(SCRIPT)
    );
    let (title, data) = (escaped(title), json(data));
    [
        MARK,
        "<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"",
        &policy,
        "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>",
        &title,
        "</title>\n<style>",
        STYLE,
        "</style>\n</head>\n<body>\n",
        body,
        "<script type=\"application/json\" id=\"data\">",
        &data,
        "</script>\n<script>",
        PLOTLY,
        "</script>\n<script>",
        SCRIPT,
        "</script>\n</body>\n</html>\n",
    ]
    .concat()
}

/// The source of a script for the policy of its page.
fn hash(script: &str) -> String {
    let hash = Sha256::digest(script.as_bytes());
    format!("'sha256-{}'", STANDARD.encode(hash))
}

/// JSON that cannot end its script element, nor begin a comment.
fn json(data: &impl Serialize) -> String {
    let text = serde_json::to_string(data).unwrap_or_else(|error| {
        // Only a type that is no JSON could fail; the script then draws nothing.
        format!("{{\"error\":{:?}}}", error.to_string())
    });
    text.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_script_of_the_page_ends_its_own_element() {
        for script in [PLOTLY, SCRIPT] {
            assert!(!script.to_ascii_lowercase().contains("</script"));
            assert!(!script.contains("<!--"));
        }
    }

    #[test]
    fn data_end_no_element_and_stay_what_they_were() {
        let text = "</script><!--<b>&\"";
        let written = json(&text);
        assert!(!written.contains('<'), "{written}");
        assert_eq!(serde_json::from_str::<String>(&written).unwrap(), text);
    }

    #[test]
    fn a_page_knows_its_own_beginning() {
        let page = document("a", "", &1);
        assert!(is_page(page.as_bytes()) && !is_page(b"<!DOCTYPE html>\n<html>"));
    }
}
