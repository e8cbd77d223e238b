//! The largest error of each segment, as exact as it is wanted.

use std::ops::Range;

use turnpath_core::Result;
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::between_instants::play;
use crate::corners::at_corners;
use crate::exactness::Exactness;
use crate::instants::{BATCH, INSTANTS, InstantBatch, batches};
use crate::sharp_peaks::sharp_peaks;
use crate::touch::{FirstTouch, Touch, TouchBuffers};
use crate::worst::Worst;

/// The middle of a segment.
const MIDDLE: f64 = 0.5;

/// Middles whose touches are searched together: as many as a batch has instants.
const TOGETHER: usize = BATCH * INSTANTS;

/// The largest error of each segment of a batch that was played.
pub(crate) fn largest_errors(
    touch: &FirstTouch,
    points: &PathBlock,
    batch: Range<usize>,
    instants: &InstantBatch,
    exactness: Exactness<'_>,
) -> Result<Vec<Worst>> {
    let mut largest: Vec<Worst> = Worst::of_batch(instants).take(batch.len()).collect();
    let peaks = sharp_peaks(
        touch,
        points,
        batch.clone(),
        (instants, &largest),
        exactness,
    )?;
    for (index, top) in peaks {
        largest[index] = largest[index].or(Some(top));
    }
    if touch.leaves_seams() {
        let corners = corners(touch, points, batch, instants)?;
        for (largest, corner) in largest.iter_mut().zip(corners) {
            *largest = largest.or(corner);
        }
    }
    Ok(largest)
}

/// The largest error at the corners of each segment of a batch.
fn corners(
    touch: &FirstTouch,
    points: &PathBlock,
    batch: Range<usize>,
    instants: &InstantBatch,
) -> Result<Vec<Option<Worst>>> {
    let touches: Vec<Touch> = (0..batch.len())
        .flat_map(|index| instants.touches(index))
        .collect();
    let segments: Vec<Segment> = batch.filter_map(|number| points.segment(number)).collect();
    at_corners(touch, &segments, &touches)
}

/// An |error| of each segment of some runs of a block, mm, one run after the other: the largest one, or one that lies on
/// the same side of all `limits`, mm.
pub(crate) fn errors_against(
    touch: &FirstTouch,
    points: &PathBlock,
    runs: &[Range<usize>],
    limits: &[f64],
) -> Result<Vec<f64>> {
    let mut instants = InstantBatch::default();
    let mut errors = Vec::with_capacity(runs.iter().map(Range::len).sum());
    for batch in runs.iter().cloned().flat_map(batches) {
        instants.play(points, batch.clone(), touch)?;
        let exactness = Exactness::Side(limits);
        let largest = largest_errors(touch, points, batch, &instants, exactness)?;
        errors.extend(largest.iter().map(Worst::amount));
    }
    Ok(errors)
}

/// The |error| in the middle of each segment of some runs of a block, mm, one run after the other. It is 0 where there is
/// no first touch: a touch that is looked for from its neighbour may be there.
pub(crate) fn errors_at_middles(
    touch: &FirstTouch,
    points: &PathBlock,
    runs: &[Range<usize>],
) -> Result<Vec<f64>> {
    let numbers: Vec<usize> = runs.iter().cloned().flatten().collect();
    let mut buffers = TouchBuffers::default();
    let mut errors = Vec::with_capacity(numbers.len());
    for some in numbers.chunks(TOGETHER) {
        let segments: Vec<Segment> = some.iter().filter_map(|i| points.segment(*i)).collect();
        let middles: Vec<(usize, f64)> = (0..segments.len()).map(|i| (i, MIDDLE)).collect();
        let found = play(touch, &segments, &middles, &mut buffers)?;
        let amount = |error: f64| if error.is_nan() { 0.0 } else { error.abs() };
        errors.extend(found.into_iter().map(amount));
    }
    Ok(errors)
}
