//! Whether a file has a path from its beginning to its end.

use serde::{Deserialize, Serialize};

/// What a file lacks of a whole path.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Wholeness {
    /// What is wrong; empty if nothing is.
    pub faults: Vec<WholenessFault>,
}

/// Why a file is not whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WholenessFault {
    /// The recipe asks for leads, and the file's first row is not that of a lead-in.
    NoLeadIn,
    /// The recipe asks for leads, and the file's last row is not that of a lead-out.
    NoLeadOut,
    /// The file's first row is in motion, where a lead-in begins at rest.
    BeginsInMotion,
    /// The file's last row is in motion, where a lead-out ends at rest.
    EndsInMotion,
}

impl Wholeness {
    /// Whether nothing is wrong.
    pub fn is_whole(&self) -> bool {
        self.faults.is_empty()
    }
}

impl WholenessFault {
    /// The fault in words.
    pub fn words(&self) -> &'static str {
        match self {
            Self::NoLeadIn => "the lead-in is missing",
            Self::NoLeadOut => "the lead-out is missing",
            Self::BeginsInMotion => {
                "the first row is in motion, but a lead-in begins at rest: rows before it are missing"
            }
            Self::EndsInMotion => {
                "the last row is in motion, but a lead-out ends at rest: rows after it are missing"
            }
        }
    }
}
