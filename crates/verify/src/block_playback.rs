//! A block played back once, for refinement and for the meter.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::playback::{PlaybackFigures, play_back};
use crate::points::errors_without_segments;
use crate::spokes::BlockSpokes;
use crate::touch::FirstTouch;

/// What the playback of a block shows: its interpolation error, from which follows whether a segment
/// is to be halved, and which the meter needs too.
#[derive(Debug, Clone, Default)]
pub struct BlockPlayback {
    /// Interpolation error.
    pub figures: PlaybackFigures,
    /// Largest |error| of each segment, mm.
    pub per_segment: Vec<f64>,
    /// Z − first touch at each control point, mm.
    pub(crate) per_point: Vec<f64>,
    pub(crate) spokes: BlockSpokes,
}

impl BlockPlayback {
    /// Plays a block back.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn of(touch: &FirstTouch, points: &PathBlock) -> Result<Self> {
        let mut per_point = errors_without_segments(touch, points)?;
        per_point.reserve(points.len());
        let (mut per_segment, mut spokes) = (Vec::new(), BlockSpokes::default());
        let part = touch.subject().part;
        let figures = play_back(touch, points, &mut per_segment, |found| {
            let [first_error, end_error] = found.end_errors();
            if per_point.is_empty() {
                per_point.push(first_error);
            }
            per_point.push(end_error);
            let ends = [points.c[found.number], points.c[found.number + 1]];
            if let Some(segment) = points.segment(found.number) {
                spokes.add(segment.c, ends, found, &part);
            }
        })?;
        Ok(Self {
            figures,
            per_segment,
            per_point,
            spokes,
        })
    }
}
