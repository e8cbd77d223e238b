//! Motion programs, measured on their own text.

use serde::{Deserialize, Serialize};

use crate::errors::Tolerances;
use crate::unit;
use crate::verdict::within;

/// What a recipe's own header or footer tells the controller besides the path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ControllerCommand {
    /// `header` or `footer`.
    pub template: String,
    /// The line in it, from 1.
    pub line: u64,
    /// The line without its comment; placeholders stand as the recipe has them.
    pub command: String,
    /// Whether all of its words are known to move nothing, set nothing and start nothing.
    pub harmless: bool,
}

/// A motion program, measured on its own text as it was read back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProgramReport {
    /// The file's name.
    pub file: String,
    /// The post that wrote it.
    pub post: String,
    /// Largest interpolation error, mm.
    #[serde(rename = "interpolation_error_nm", with = "unit::nm")]
    pub interpolation_error: f64,
    /// Whether that holds the interpolation tolerance.
    pub within_interpolation: bool,
    /// Smallest height of Z above the first touch on the leads, mm; `None` without leads.
    #[serde(rename = "lead_clearance_nm", with = "unit::nm")]
    pub lead_clearance: Option<f64>,
    /// Whether the leads stay above the first touch, to the interpolation tolerance; `None` without
    /// leads.
    pub within_lead: Option<bool>,
}

impl ProgramReport {
    /// Judges a program by its largest interpolation error and the smallest clearance of its
    /// leads, mm.
    pub fn new(
        file: String,
        post: &str,
        interpolation_error: f64,
        lead_clearance: Option<f64>,
        tolerance: &Tolerances,
    ) -> Self {
        let allowed = tolerance.interpolation;
        Self {
            file,
            post: post.to_owned(),
            interpolation_error,
            within_interpolation: within(interpolation_error, allowed),
            lead_clearance,
            within_lead: lead_clearance.map(|clearance| within(-clearance, allowed)),
        }
    }

    /// Whether the program holds its tolerances.
    pub fn holds(&self) -> bool {
        self.within_interpolation && self.within_lead.unwrap_or(true)
    }
}
