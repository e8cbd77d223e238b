//! The lower side of the nose: an arc around the nose's centre.

use nalgebra::Vector2;

/// How far the nose's lower side lies below its centre, at this distance to the side, mm. Beyond the nose,
/// which only rounding can reach, it is zero.
#[inline(always)]
pub(crate) fn below_centre(radius: f64, offset: f64) -> f64 {
    (radius * radius - offset * offset).max(0.0).sqrt()
}

/// The height at `s` of the lower side of a nose around `centre`, mm.
#[inline(always)]
pub(crate) fn lower_arc(centre: Vector2<f64>, radius: f64, s: f64) -> f64 {
    centre.y - below_centre(radius, s - centre.x)
}
