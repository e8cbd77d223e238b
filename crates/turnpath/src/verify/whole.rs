//! Whether a file has a whole path, by its own first and last rows.
//!
//! A path with leads begins and ends at rest. A file that lost rows at an end has a row in motion
//! there, or lacks a lead. Straight lines have no velocity at their ends, so of them only the sections
//! count. A path without leads begins and ends in motion: its reach shows what it lacks, and so do
//! the rows of the recipe's path.

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section, SegmentShape};
use turnpath_recipe::Recipe;
use turnpath_report::{Wholeness, WholenessFault};

/// The largest velocity at rest, mm/s or deg/s: a last digit of a program as it is written by
/// default. A program with fewer digits has a coarser rest.
const REST: f64 = 1e-7;

/// The first or the last row of a file.
pub type EndRow = (ControlPoint, Section);

/// What a file lacks between its first and its last row; `None` if its recipe asks for no leads.
/// `digit` is the last digit of its velocities, mm/s or deg/s; zero if it has all digits.
pub fn wholeness(
    recipe: &Recipe,
    shape: SegmentShape,
    digit: f64,
    (first, last): (EndRow, EndRow),
) -> Option<Wholeness> {
    if !recipe.lead {
        return None;
    }
    let largest = REST.max(digit);
    let moves = |point: &ControlPoint| {
        let velocities = [point.vc / DEG, point.vx, point.vz];
        shape == SegmentShape::Cubic && velocities.iter().any(|v| v.abs() > largest)
    };
    let begin = match first.1 {
        Section::LeadIn => moves(&first.0).then_some(WholenessFault::BeginsInMotion),
        Section::Cutting | Section::LeadOut => Some(WholenessFault::NoLeadIn),
    };
    let end = match last.1 {
        Section::LeadOut => moves(&last.0).then_some(WholenessFault::EndsInMotion),
        Section::LeadIn | Section::Cutting => Some(WholenessFault::NoLeadOut),
    };
    let faults = [begin, end].into_iter().flatten().collect();
    Some(Wholeness { faults })
}
