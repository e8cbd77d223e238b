//! Playback: how far the played tool centre is from the true one, along z.

use turnpath_core::Result;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::exactness::Exactness;
use crate::instants::{BATCH, INSTANTS, InstantBatch, batches};
use crate::largest_errors::largest_errors;
use crate::spokes::SegmentErrors;
use crate::touch::FirstTouch;
use crate::worst::Worst;

/// The interpolation error of a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaybackFigures {
    /// The error with the largest amount, signed: played − true, mm.
    pub extreme: f64,
    /// C of its position, unwrapped, rad.
    pub at_c: f64,
    /// X of its position, mm.
    pub at_x: f64,
    /// Time of the segment in which it is, s.
    pub segment_time: f64,
    /// Time of the longest segment, s.
    pub longest_time: f64,
    /// Time integral of the error's square, mm²·s.
    square: f64,
    /// Time measured, s.
    time: f64,
    /// Whether an error was NaN. The position is then that of the first such error.
    broken: bool,
}

impl PlaybackFigures {
    /// Largest |played − true|, mm; infinite if an error is NaN or nothing was measured.
    pub fn max(&self) -> f64 {
        if self.broken || self.time == 0.0 {
            f64::INFINITY
        } else {
            self.extreme.abs()
        }
    }

    /// Root of the mean square over time, mm.
    pub fn rms(&self) -> f64 {
        if self.time > 0.0 {
            (self.square / self.time).sqrt()
        } else {
            0.0
        }
    }

    /// Includes the largest error of a segment.
    fn include(&mut self, worst: Worst, segment: impl FnOnce() -> Option<Segment>) {
        let worse =
            !self.broken && (worst.error.is_nan() || worst.error.abs() > self.extreme.abs());
        if let Some(segment) = worse.then(segment).flatten() {
            self.broken = worst.error.is_nan();
            self.extreme = worst.error;
            self.at_c = segment.c.value(worst.at);
            self.at_x = segment.x.value(worst.at);
            self.segment_time = segment.duration;
        }
    }

    /// Appends the figures of the path's next block.
    pub fn append(&mut self, next: &Self) {
        self.square += next.square;
        self.time += next.time;
        self.longest_time = self.longest_time.max(next.longest_time);
        if !self.broken && (next.broken || next.extreme.abs() > self.extreme.abs()) {
            self.broken = next.broken;
            (self.extreme, self.at_c, self.at_x) = (next.extreme, next.at_c, next.at_x);
            self.segment_time = next.segment_time;
        }
    }
}

/// What was found on one segment.
pub(crate) struct SegmentPlayback<'a> {
    /// The number of the segment in its block.
    pub number: usize,
    instants: &'a InstantBatch,
    index: usize,
}

impl SegmentPlayback<'_> {
    /// Played − true Z at both of its control points, mm.
    pub fn end_errors(&self) -> [f64; 2] {
        self.instants.end_errors(self.index)
    }
}

impl SegmentErrors for SegmentPlayback<'_> {
    fn error(&self, instant: usize) -> f64 {
        self.instants.error_at(self.index, instant)
    }

    fn foot(&self, instant: usize) -> f64 {
        self.instants.foot(self.index, instant)
    }
}

/// Plays `points` back, writes the largest |error| of each segment to `per_segment`, mm, and
/// returns the figures of the block. `seen` gets what was found on each segment.
pub(crate) fn play_back(
    touch: &FirstTouch,
    points: &PathBlock,
    per_segment: &mut Vec<f64>,
    mut seen: impl FnMut(&SegmentPlayback<'_>),
) -> Result<PlaybackFigures> {
    let count = points.len().saturating_sub(1);
    let mut figures = PlaybackFigures::default();
    let mut instants = InstantBatch::default();
    per_segment.clear();
    for batch in batches(0..count) {
        instants.play(points, batch.clone(), touch)?;
        let squares = in_widest(Squares(&instants));
        let largest = largest_errors(touch, points, batch.clone(), &instants, Exactness::Full)?;
        let largest = largest.into_iter().zip(squares);
        for (index, (number, (worst, square))) in batch.zip(largest).enumerate() {
            let duration = points.t[number + 1] - points.t[number];
            figures.square += square * duration / INSTANTS as f64;
            figures.time += duration;
            figures.longest_time = figures.longest_time.max(duration);
            figures.include(worst, || points.segment(number));
            seen(&SegmentPlayback {
                number,
                instants: &instants,
                index,
            });
            per_segment.push(worst.amount());
        }
    }
    Ok(figures)
}

/// The loop that sums up the squares of the errors of each segment.
struct Squares<'a>(&'a InstantBatch);

impl Loop for Squares<'_> {
    type Output = [f64; BATCH];

    #[inline(always)]
    fn call(self) -> [f64; BATCH] {
        let mut squares = [0.0; BATCH];
        for errors in self.0.each_instant() {
            for (square, error) in squares.iter_mut().zip(errors) {
                *square += error * error;
            }
        }
        squares
    }
}
