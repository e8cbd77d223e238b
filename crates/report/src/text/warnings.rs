//! What a person should read of a run beside its verdict.

use crate::run::RunReport;

use super::coverage::axis_crossing_warning;
use super::lead::lead_warning;
use super::path::{gouge_warning, real_nose_warning};
use super::remark::sentence;

/// The warnings and the remarks of a run, as in its [text](super::run). They change no verdict.
pub fn warnings(report: &RunReport) -> Vec<String> {
    let path = &report.path;
    let nose = path.real_nose.as_ref().map(|nose| {
        let (gouge, left) = real_nose_warning(nose);
        left.map_or_else(|| gouge.clone(), |left| format!("{gouge}, {left}"))
    });
    let crossing = axis_crossing_warning(&path.axis_crossing);
    let lead = path.lead.as_ref().and_then(lead_warning);
    let remarks = report.remarks.iter().map(sentence);
    [nose, gouge_warning(path), crossing, lead]
        .into_iter()
        .flatten()
        .chain(remarks)
        .collect()
}
