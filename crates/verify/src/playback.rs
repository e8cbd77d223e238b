//! Playback: how far the played tool centre is from the true one, along z.

use turnpath_core::Result;
use turnpath_core::toolpath::{PathBlock, Segment};

use crate::touch::{FirstTouch, Touch};

/// Instants of each segment at which the played position is compared, its start among them and
/// its middle. The error of a cubic is a bump over the segment: 16 places see it to 0.5 %.
pub const INSTANTS: usize = 16;
/// Segments that are played back in one batch.
const BATCH: usize = 64;

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
    /// Largest |played − true|, mm; infinite where there was no number.
    pub fn max(&self) -> f64 {
        if self.broken {
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

    fn see(&mut self, error: f64, weight: f64, c: f64, x: f64) {
        self.square += error * error * weight;
        self.time += weight;
        let worse = !self.broken && (error.is_nan() || error.abs() > self.extreme.abs());
        if worse {
            self.broken = error.is_nan();
            (self.extreme, self.at_c, self.at_x) = (error, c, x);
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
        for (i, segment) in batch.iter().enumerate() {
            let weight = segment.duration / INSTANTS as f64;
            let mut largest = 0.0f64;
            for k in i * INSTANTS..(i + 1) * INSTANTS {
                let error = room.z[k] - room.touches[k].z;
                figures.see(error, weight, room.c[k], room.x[k]);
                largest = if error.is_nan() {
                    f64::INFINITY
                } else {
                    largest.max(error.abs())
                };
            }
            per_segment.push(largest);
        }
    }
    Ok(figures)
}

/// Room for a batch of instants.
#[derive(Default)]
struct Room {
    c: Vec<f64>,
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    touches: Vec<Touch>,
}

impl Room {
    fn play(&mut self, batch: &[Segment], touch: &FirstTouch) -> Result<()> {
        for places in [&mut self.c, &mut self.theta, &mut self.x, &mut self.z] {
            places.clear();
        }
        for segment in batch {
            for k in 0..INSTANTS {
                let s = k as f64 / INSTANTS as f64;
                let c = segment.c.value(s);
                self.c.push(c);
                self.theta.push(c.rem_euclid(std::f64::consts::TAU));
                self.x.push(segment.x.value(s));
                self.z.push(segment.z.value(s));
            }
        }
        touch.find(&self.theta, &self.x, &mut self.touches)
    }
}
