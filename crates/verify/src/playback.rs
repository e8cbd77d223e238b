//! Playback: how far the played tool centre is from the true one, along z.

use turnpath_core::Result;
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::corners::at_corners;
use crate::touch::{FirstTouch, Touch};

/// Instants of each segment at which the played position is compared, its start among them and
/// its middle. The error of a cubic is a bump over the segment, or a few: the largest of 16
/// places misses its top by up to 1 %, the parabola through it and its neighbours by 0.1 %.
pub const INSTANTS: usize = 16;
/// Segments that are played back in one batch.
pub(crate) const BATCH: usize = 64;

/// The interpolation error of a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaybackFigures {
    /// Signed error of largest amount, played − true, mm.
    pub extreme: f64,
    /// C where it is, unwrapped, rad.
    pub at_c: f64,
    /// X where it is, mm.
    pub at_x: f64,
    /// Time integral of the error's square, mm²·s.
    square: f64,
    /// Time measured, s.
    time: f64,
    /// Set once an error was no number: its place is the one above.
    broken: bool,
}

impl PlaybackFigures {
    /// Largest |played − true|, mm; infinite where there was no number, or nothing to measure.
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

    fn see(&mut self, worst: Worst, segment: &Segment) {
        let worse =
            !self.broken && (worst.error.is_nan() || worst.error.abs() > self.extreme.abs());
        if worse {
            self.broken = worst.error.is_nan();
            self.extreme = worst.error;
            self.at_c = segment.c.value(worst.at);
            self.at_x = segment.x.value(worst.at);
        }
    }

    /// Puts the figures of the path's next stretch behind these.
    pub fn append(&mut self, next: &Self) {
        self.square += next.square;
        self.time += next.time;
        if !self.broken && (next.broken || next.extreme.abs() > self.extreme.abs()) {
            self.broken = next.broken;
            (self.extreme, self.at_c, self.at_x) = (next.extreme, next.at_c, next.at_x);
        }
    }
}

/// Plays `points` back; writes the largest |error| of each segment, and gives the figures.
pub fn play_back(
    touch: &FirstTouch,
    points: &PathBlock,
    per_segment: &mut Vec<f64>,
) -> Result<PlaybackFigures> {
    let segments: Vec<Segment> = points.segments().collect();
    let mut figures = PlaybackFigures::default();
    let mut room = Room::default();
    per_segment.clear();
    for batch in segments.chunks(BATCH) {
        room.play(batch, touch)?;
        let corners = match touch.leaves_seams() {
            true => at_corners(touch, batch, &room.touches)?,
            false => Vec::new(),
        };
        for (i, segment) in batch.iter().enumerate() {
            let errors = room.errors(i);
            let square: f64 = errors.iter().map(|error| error * error).sum();
            figures.square += square * segment.duration / INSTANTS as f64;
            figures.time += segment.duration;
            let worst = Worst::of(&errors).or(corners.get(i).copied().flatten());
            figures.see(worst, segment);
            per_segment.push(worst.amount());
        }
    }
    Ok(figures)
}

/// The largest error of one segment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    /// Signed, played − true, mm.
    pub error: f64,
    /// Where in the segment, 0 to 1.
    pub at: f64,
}

impl Worst {
    fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.amount() > self.amount() => other,
            _ => self,
        }
    }

    fn of(errors: &[f64; INSTANTS]) -> Self {
        let mut worst = 0;
        for (k, error) in errors.iter().enumerate() {
            if error.is_nan() || error.abs() > errors[worst].abs() {
                worst = k;
            }
            if error.is_nan() {
                break;
            }
        }
        let (rise, shift) = match worst.checked_sub(1).and_then(|k| errors.get(k..k + 3)) {
            Some(&[before, top, after]) => beyond_sample(before, top, after),
            _ => (0.0, 0.0),
        };
        Self {
            error: errors[worst] + rise,
            at: (worst as f64 + shift) / INSTANTS as f64,
        }
    }

    /// Its amount; infinite where it is no number.
    pub fn amount(&self) -> f64 {
        if self.error.is_nan() {
            f64::INFINITY
        } else {
            self.error.abs()
        }
    }
}

/// By how much the parabola through three neighbours goes beyond the middle one, the largest, and
/// how many steps on.
fn beyond_sample(before: f64, top: f64, after: f64) -> (f64, f64) {
    let (tilt, bend) = (0.5 * (after - before), 2.0 * top - before - after);
    let shift = tilt / bend;
    if shift.abs() <= 0.5 {
        (0.5 * tilt * shift, shift)
    } else {
        (0.0, 0.0)
    }
}

/// Room for a batch of instants.
#[derive(Default)]
pub(crate) struct Room {
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    touches: Vec<Touch>,
}

impl Room {
    /// Played − true Z of a segment of the batch, mm.
    pub(crate) fn errors(&self, segment: usize) -> [f64; INSTANTS] {
        std::array::from_fn(|k| {
            let instant = segment * INSTANTS + k;
            self.z[instant] - self.touches[instant].z
        })
    }

    /// X played at an instant of a segment of the batch, mm.
    pub(crate) fn x(&self, segment: usize, instant: usize) -> f64 {
        self.x[segment * INSTANTS + instant]
    }

    /// Plays segments, and finds the first touch at each instant.
    pub(crate) fn play(&mut self, batch: &[Segment], touch: &FirstTouch) -> Result<()> {
        for places in [&mut self.theta, &mut self.x, &mut self.z] {
            places.clear();
        }
        for segment in batch {
            for k in 0..INSTANTS {
                let s = k as f64 / INSTANTS as f64;
                let c = segment.c.value(s);
                self.theta.push(c.rem_euclid(std::f64::consts::TAU));
                self.x.push(segment.x.value(s));
                self.z.push(segment.z.value(s));
            }
        }
        touch.find(&self.theta, &self.x, &mut self.touches)
    }
}
