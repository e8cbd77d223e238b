//! Sharp peaks of the error. Where the nose rolls over a ridge, the error has a peak with nearly straight flanks.
//! Its top lies between two instants, and a parabola through instants does not reach it.

use std::ops::Range;

use turnpath_core::Result;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::between_instants::play;
use crate::exactness::Exactness;
use crate::instants::{BATCH, INSTANTS, InstantBatch};
use crate::touch::{FirstTouch, TouchBuffers};
use crate::worst::Worst;

/// A segment may have a sharp peak if a sixth difference of its errors exceeds this part of the largest one. The top
/// of a peak with straight flanks lies above its highest instant by no more than the largest sixth difference, and far
/// from the segment's ends by a sixth of it. The error of a cubic on a smooth path is nearly a quartic, whose sixth
/// differences are zero.
const SHARP: f64 = 0.02;
/// How far a top may lie above the highest known error, in sixth differences. A single peak with straight flanks rises by
/// one at the most; differences of several peaks may cancel in part.
const HIGHEST: f64 = 2.0;
/// Sixth differences below this are rounding or too small to matter, mm: a thousandth of a nanometre.
const SMALL: f64 = 1e-9;
/// Errors of a sixth difference.
const STENCIL: usize = 7;
/// Rounds of the search for a top. Two of them halve its interval: in the end it is a thousandth of the segment.
const ROUNDS: usize = 14;

/// The interval in which a top is searched: two times within a segment, 0 to 1, and the highest place between them.
struct Peak {
    /// The number of the segment in its batch.
    segment: usize,
    lower: f64,
    upper: f64,
    top: Worst,
}

/// The tops of sharp peaks, each with the number of its segment in the batch. `largest` are the largest errors that are
/// known of each segment. A peak that cannot be higher than these is left out, and so is one whose top makes no
/// difference at this exactness.
pub(crate) fn sharp_peaks(
    touch: &FirstTouch,
    points: &PathBlock,
    batch: Range<usize>,
    (instants, largest): (&InstantBatch, &[Worst]),
    exactness: Exactness<'_>,
) -> Result<Vec<(usize, Worst)>> {
    let bends = in_widest(SixthDifferences(instants));
    let mut peaks = Vec::new();
    for (segment, (largest, bend)) in largest.iter().zip(bends).enumerate() {
        let largest = largest.amount();
        let may_be_sharp = bend > SMALL.max(SHARP * largest);
        let known = largest.max(instants.error_at(segment, INSTANTS).abs());
        if may_be_sharp && exactness.distinguishes(known, HIGHEST * bend) {
            peaks.extend(peaks_of(instants, segment, largest));
        }
    }
    if peaks.is_empty() {
        return Ok(Vec::new());
    }
    let segments: Vec<Segment> = batch.filter_map(|number| points.segment(number)).collect();
    let mut buffers = TouchBuffers::default();
    for _ in 0..ROUNDS {
        let places: Vec<(usize, f64)> = peaks
            .iter()
            .map(|peak| (peak.segment, peak.next()))
            .collect();
        let errors = play(touch, &segments, &places, &mut buffers)?;
        for ((peak, (_, at)), error) in peaks.iter_mut().zip(places).zip(errors) {
            peak.close_in(Worst { error, at });
        }
    }
    let tops = peaks.into_iter().map(|peak| (peak.segment, peak.top));
    Ok(tops.collect())
}

/// The peaks of a segment that may be higher than the largest error that is known, mm.
fn peaks_of(
    instants: &InstantBatch,
    segment: usize,
    largest: f64,
) -> impl Iterator<Item = Peak> + '_ {
    let times = (0..=INSTANTS).filter(move |time| may_be_higher(instants, segment, *time, largest));
    times.map(move |time| {
        let at = |time: usize| time as f64 / INSTANTS as f64;
        Peak {
            segment,
            lower: at(time.saturating_sub(1)),
            upper: at((time + 1).min(INSTANTS)),
            top: Worst {
                error: instants.error_at(segment, time),
                at: at(time),
            },
        }
    })
}

/// Whether the error at one of 17 times is no smaller than at its neighbours, and its peak may be higher than the
/// largest error that is known. A flank goes on no further than it went in the step before. At the ends of the
/// segment one flank is not known.
fn may_be_higher(instants: &InstantBatch, segment: usize, time: usize, largest: f64) -> bool {
    let top = instants.error_at(segment, time);
    let beside = [
        time.checked_sub(1),
        Some(time + 1).filter(|time| *time <= INSTANTS),
    ];
    let beside = beside.map(|time| time.map(|time| instants.error_at(segment, time)));
    let is_top = beside
        .iter()
        .flatten()
        .all(|error| top.abs() >= error.abs());
    match beside {
        [Some(before), Some(after)] => {
            let rise = (top - before).abs().max((top - after).abs());
            is_top && top.abs() + rise > largest
        }
        _ => is_top,
    }
}

impl Peak {
    /// The next place to be played: the middle of the longer side.
    fn next(&self) -> f64 {
        let end = match self.top.at - self.lower > self.upper - self.top.at {
            true => self.lower,
            false => self.upper,
        };
        0.5 * (self.top.at + end)
    }

    /// Closes in on the top: what was played is the new top, or an end of the interval.
    fn close_in(&mut self, played: Worst) {
        let end = match played.amount() > self.top.amount() {
            true => std::mem::replace(&mut self.top, played).at,
            false => played.at,
        };
        match end < self.top.at {
            true => self.lower = end,
            false => self.upper = end,
        }
    }
}

/// The loop over the largest sixth difference of the errors of each segment, mm.
struct SixthDifferences<'a>(&'a InstantBatch);

impl Loop for SixthDifferences<'_> {
    type Output = [f64; BATCH];

    #[inline(always)]
    fn call(self) -> [f64; BATCH] {
        let columns: Vec<&[f64]> = self.0.each_time().collect();
        let mut largest = [0.0_f64; BATCH];
        for window in columns.windows(STENCIL) {
            let Ok(errors) = <[&[f64]; STENCIL]>::try_from(window) else {
                continue;
            };
            // Columns of one known length need no look at their ends in the loop.
            let count = errors[0].len().min(BATCH);
            let [a, b, c, d, e, f, g] = errors.map(|column| &column[..count]);
            let largest = &mut largest[..count];
            for i in 0..count {
                let beside = 15.0 * (c[i] + e[i]) - 20.0 * d[i];
                let difference = (a[i] + g[i]) - 6.0 * (b[i] + f[i]) + beside;
                largest[i] = largest[i].max(difference.abs());
            }
        }
        largest
    }
}
