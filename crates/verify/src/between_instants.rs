//! Playback at any times within segments, between the instants too.

use turnpath_core::Result;
use turnpath_core::toolpath::Segment;

use crate::touch::{FirstTouch, Touch};

/// The first touches at times within segments, and played − true Z there, mm.
pub(crate) fn play(
    touch: &FirstTouch,
    segments: &[Segment],
    instants: &[(usize, f64)],
) -> Result<(Vec<Touch>, Vec<f64>)> {
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
    let mut touches = Vec::new();
    touch.find(&theta, &x, &mut touches)?;
    let errors = z
        .iter()
        .zip(&touches)
        .map(|(z, touch)| z - touch.z)
        .collect();
    Ok((touches, errors))
}
