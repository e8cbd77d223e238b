//! The paths before the finishing one, for a person.

use crate::rough_path::RoughPathReport;

use super::numbers::{duration, grouped, line, small_length};

/// The lines on a rough path.
pub(super) fn rough_path(rough: &RoughPathReport) -> String {
    let left = match &rough.left {
        Some(left) => format!(
            "leaves {} to {} of {}",
            small_length(left.least),
            small_length(left.most),
            small_length(rough.allowance)
        ),
        None => "cuts nothing of the part".to_owned(),
    };
    let mut text = line(&format!("pass {}", rough.name), left);
    let (points, time) = (grouped(rough.control_points), duration(rough.cutting_time));
    text += &line("", format!("{points} points, {time}"));
    let failures: Vec<&str> = rough.within.failures().collect();
    if !failures.is_empty() {
        text += &line("", format!("EXCEEDED: {}", failures.join(", ")));
    }
    text
}
