//! What the summary beside a file says of it.

use serde::{Deserialize, Serialize};

/// What the summary beside a file of a tool path says of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultCheck {
    /// The summary.
    pub summary: String,
    /// Whether the file has the bytes that the summary lists.
    pub holds: bool,
    /// What is wrong with the file or with the result that it belongs to.
    pub notes: Vec<String>,
}
