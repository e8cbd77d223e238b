//! Playback at any times within segments, between the instants too.

use turnpath_core::Result;
use turnpath_core::toolpath::Segment;

use crate::touch::{FirstTouch, TouchBuffers};

/// Played − true Z at times within segments, mm. The first touches there are left in `buffers`.
pub(crate) fn play(
    touch: &FirstTouch,
    segments: &[Segment],
    instants: &[(usize, f64)],
    buffers: &mut TouchBuffers,
) -> Result<Vec<f64>> {
    let of = |axis: fn(&Segment, f64) -> f64| -> Vec<f64> {
        instants
            .iter()
            .map(|(segment, at)| axis(&segments[*segment], *at))
            .collect()
    };
    let theta = of(|segment, at| segment.c.value(at).rem_euclid(std::f64::consts::TAU));
    let (x, z) = (
        of(|segment, at| segment.x.value(at)),
        of(|segment, at| segment.z.value(at)),
    );
    touch.find_in(&theta, &x, buffers)?;
    let heights = z.iter().zip(&buffers.touches.z);
    Ok(heights.map(|(played, touch)| played - touch).collect())
}
