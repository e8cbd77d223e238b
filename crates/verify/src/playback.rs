//! Playback: how far the played tool centre is from the true one, along z.

use turnpath_core::Result;
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::corners::at_corners;
use crate::instants::{BATCH, INSTANTS, InstantBatch};
use crate::touch::{FirstTouch, Touch};
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

    fn include(&mut self, worst: Worst, segment: &Segment) {
        let worse =
            !self.broken && (worst.error.is_nan() || worst.error.abs() > self.extreme.abs());
        if worse {
            self.broken = worst.error.is_nan();
            self.extreme = worst.error;
            self.at_c = segment.c.value(worst.at);
            self.at_x = segment.x.value(worst.at);
        }
    }

    /// Appends the figures of the path's next block.
    pub fn append(&mut self, next: &Self) {
        self.square += next.square;
        self.time += next.time;
        if !self.broken && (next.broken || next.extreme.abs() > self.extreme.abs()) {
            self.broken = next.broken;
            (self.extreme, self.at_c, self.at_x) = (next.extreme, next.at_c, next.at_x);
        }
    }
}

/// What was found on one segment.
pub(crate) struct SegmentPlayback<'a> {
    /// The number of the segment in its block.
    pub number: usize,
    /// What is played.
    pub segment: &'a Segment,
    /// Played − true Z at each instant, mm.
    pub errors: [f64; INSTANTS],
    /// The first touch at each instant.
    pub touches: &'a [Touch],
}

/// Plays `points` back, writes the largest |error| of each segment to `per_segment`, mm, and
/// returns the figures of the block. `seen` gets what was found on each segment.
pub(crate) fn play_back(
    touch: &FirstTouch,
    points: &PathBlock,
    per_segment: &mut Vec<f64>,
    mut seen: impl FnMut(&SegmentPlayback<'_>),
) -> Result<PlaybackFigures> {
    let (mut segments, mut batch) = (points.segments(), Vec::with_capacity(BATCH));
    let mut figures = PlaybackFigures::default();
    let mut instants = InstantBatch::default();
    per_segment.clear();
    loop {
        batch.clear();
        batch.extend(segments.by_ref().take(BATCH));
        if batch.is_empty() {
            break;
        }
        instants.play(&batch, touch)?;
        let corners = match touch.leaves_seams() {
            true => at_corners(touch, &batch, instants.touches())?,
            false => Vec::new(),
        };
        for (i, segment) in batch.iter().enumerate() {
            let errors = instants.errors(i);
            let square: f64 = errors.iter().map(|error| error * error).sum();
            figures.square += square * segment.duration / INSTANTS as f64;
            figures.time += segment.duration;
            let worst = Worst::of(&errors).or(corners.get(i).copied().flatten());
            figures.include(worst, segment);
            seen(&SegmentPlayback {
                number: per_segment.len(),
                segment,
                errors,
                touches: &instants.touches()[i * INSTANTS..(i + 1) * INSTANTS],
            });
            per_segment.push(worst.amount());
        }
    }
    Ok(figures)
}
