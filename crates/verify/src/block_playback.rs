//! A block played back once, for refinement and for the meter.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::playback::{PlaybackFigures, play_back};
use crate::points::point_errors;
use crate::spokes::{BlockSpokes, SegmentErrors};
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
        let per_point = point_errors(touch, points)?;
        let (mut per_segment, mut spokes) = (Vec::new(), BlockSpokes::default());
        let part = touch.subject().part;
        let figures = play_back(touch, points, &mut per_segment, |found| {
            let Some(segment) = points.segment(found.number) else {
                return;
            };
            let (end, errors) = (found.number + 1, found.errors());
            let errors = SegmentErrors {
                segment: &segment,
                ends: [points.c[end - 1], points.c[end]],
                errors: std::array::from_fn(|k| match errors.get(k) {
                    Some(error) => *error,
                    None => per_point[end],
                }),
                feet: found.feet(),
            };
            spokes.add(&errors, &part);
        })?;
        Ok(Self {
            figures,
            per_segment,
            per_point,
            spokes,
        })
    }
}
