//! A place that was cut and where the surface has no height.

use turnpath_core::StrategyError;

/// The error of a surface without a height at a place of the part, mm.
pub fn no_height(x: f64, y: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the surface has no height at x = {x:.4} mm, y = {y:.4} mm"
    ))
}
