//! A curve in the YZ plane that is turned about an axis parallel to Y.

use turnpath_plugin::prelude::*;

/// The height z at x of a curve of height u above y, turned about an axis parallel to y at the
/// distance 1/curvature: (1/c − z)² + x² = (1/c − u)².
///
/// It is free of cancellation: z = (u(2 − cu) + cx²) / (1 + sqrt((1 − cu)² − c²x²)). It is NaN where
/// the curve has reached the axis, and beyond the turned curve.
#[inline(always)]
pub fn revolved<S: Scalar>(u: S, x: S, curvature: f64) -> S {
    let to_axis = -(u * curvature) + 1.0;
    let across = x * curvature;
    let below_root = (to_axis - across) * (to_axis + across);
    let beyond_axis = to_axis.less(S::constant(0.0));
    let root = S::select(beyond_axis, S::constant(-1.0), below_root).sqrt();
    (u * (to_axis + 1.0) + x * across) / (root + 1.0)
}
