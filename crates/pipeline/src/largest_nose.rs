//! The largest nose that fits a part, its overrun included.

use turnpath_core::largest_nose::LargestNose;

use crate::fit::Fit;
use crate::{LocusLinks, Preparation, Result};

/// The largest nose for the strategies and the task, with what limits it.
///
/// # Errors
/// When a strategy fails.
pub fn largest_nose(links: &LocusLinks, preparation: &Preparation) -> Result<LargestNose> {
    let task = &preparation.task;
    let fit = Fit::new(links, task.part, task.tool, preparation.overrun);
    fit.largest_nose(preparation.curvature_on_part)
}
