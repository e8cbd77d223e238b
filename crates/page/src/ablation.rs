//! The page of an ablation.

use serde::{Deserialize, Serialize};
use turnpath_report::AblationReport;

use crate::document::document;
use crate::html::{element, section};

/// The data of an ablation's page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AblationPage {
    /// What the ablation gave.
    pub report: AblationReport,
}

/// The page of an ablation.
pub fn ablation_page(page: &AblationPage) -> String {
    let body = section(
        "runs",
        "Runs",
        &element("p", "", &page.report.runs.len().to_string()),
    );
    document("Ablation", &body, &serde_json::json!({"kind": "ablation"}))
}
