//! First touches of long columns, in batches that stay in the cache.

use turnpath_core::Result;

use crate::touch::{FirstTouch, Touch, TouchBuffers};

/// Positions of a batch: their columns take some tens of kilobytes.
const BATCH: usize = 1024;

/// The first touch at each (θ, X).
///
/// # Errors
/// When the surface fails.
pub(crate) fn touches_at(touch: &FirstTouch, theta: &[f64], x: &[f64]) -> Result<Vec<Touch>> {
    let mut all = Vec::with_capacity(x.len());
    let mut buffers = TouchBuffers::default();
    for (theta, x) in theta.chunks(BATCH).zip(x.chunks(BATCH)) {
        touch.find_in(theta, x, &mut buffers)?;
        all.extend(buffers.touches.iter());
    }
    Ok(all)
}
