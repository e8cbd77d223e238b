//! What all files of the search for first touches must know.

/// Searches side by side. Their columns take 22 kB, which stays in the nearest cache.
pub(crate) const WIDTH: usize = 128;
/// Rκ up to which the nose's height is taken to have a single maximum. It is a little below 1, since the
/// curvature may be larger between the points of the grid at which it is computed.
pub(crate) const SURE_FIT: f64 = 0.95;
