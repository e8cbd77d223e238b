//! How far two paths that share both ends are apart as played.

use std::f64::consts::TAU;

use turnpath_core::Result;
use turnpath_core::toolpath::{ControlPoint, Segment, SegmentShape};

use crate::instants::INSTANTS;
use crate::touch::FirstTouch;

/// Positions of each path that are held against the surface in one batch. They take some kilobytes,
/// however long a stretch is.
const BATCH: usize = 1024;

/// Control points of a path between two of its rows, both included.
pub struct Stretch {
    segments: Vec<Segment>,
    /// Its first time, s.
    start: f64,
    /// How long it takes, s.
    duration: f64,
}

/// Where the tool is: C, X and Z.
struct Position([f64; 3]);

impl Stretch {
    /// What is played between these points.
    pub fn new(points: impl Iterator<Item = ControlPoint> + Clone, shape: SegmentShape) -> Self {
        let between = match shape {
            SegmentShape::Cubic => Segment::between,
            SegmentShape::Linear => Segment::straight,
        };
        let pairs = points.clone().zip(points.clone().skip(1));
        let segments = pairs.map(|(from, to)| between(&from, &to)).collect();
        let start = points.clone().next().map_or(0.0, |first| first.t);
        let end = points.last().map_or(start, |last| last.t);
        Self {
            segments,
            start,
            duration: end - start,
        }
    }

    /// Instants within each segment and at its ends, as parts of the duration.
    fn instants(&self) -> impl Iterator<Item = f64> + '_ {
        let within = |segment: &Segment| {
            let (from, time) = (segment.start - self.start, segment.duration);
            (0..=INSTANTS).map(move |k| from + time * k as f64 / INSTANTS as f64)
        };
        let all = self.segments.iter().flat_map(within);
        all.map(|time| (time / self.duration).clamp(0.0, 1.0))
    }

    /// Where the tool is after this part of the duration.
    fn at(&self, part: f64) -> Option<Position> {
        let time = self.start + part * self.duration;
        let after = self
            .segments
            .partition_point(|segment| segment.start <= time);
        let segment = self.segments.get(after.saturating_sub(1))?;
        let s = ((time - segment.start) / segment.duration).clamp(0.0, 1.0);
        Some(Position([
            segment.c.value(s),
            segment.x.value(s),
            segment.z.value(s),
        ]))
    }
}

/// The largest difference of the heights of two stretches above the first touch, mm. The stretches
/// are played side by side, each over its own duration. A shift of C or X counts by what it does to
/// the height above the surface below. Where there is no surface, the heights themselves count.
///
/// # Errors
/// When the surface fails.
pub fn distance(touch: &FirstTouch, file: &Stretch, remade: &Stretch) -> Result<f64> {
    let instants = remade.instants().chain(file.instants());
    let mut positions = instants.filter_map(|part| Some([file.at(part)?, remade.at(part)?]));
    let mut largest: f64 = 0.0;
    loop {
        let batch: Vec<[Position; 2]> = positions.by_ref().take(BATCH).collect();
        if batch.is_empty() {
            return Ok(largest);
        }
        let apart = largest_of(touch, &batch)?;
        if apart.is_nan() {
            return Ok(f64::NAN);
        }
        largest = largest.max(apart);
    }
}

/// The largest difference of the heights at these positions of both paths, mm.
fn largest_of(touch: &FirstTouch, positions: &[[Position; 2]]) -> Result<f64> {
    let all = || positions.iter().flatten();
    let theta: Vec<f64> = all().map(|Position([c, ..])| c.rem_euclid(TAU)).collect();
    let x: Vec<f64> = all().map(|Position([_, x, _])| *x).collect();
    let mut touches = Vec::new();
    touch.find(&theta, &x, &mut touches)?;
    let mut largest: f64 = 0.0;
    for ([file, remade], below) in positions.iter().zip(touches.chunks_exact(2)) {
        let lifted = below[0].z - below[1].z;
        let surface = if lifted.is_finite() { lifted } else { 0.0 };
        let apart = (file.0[2] - remade.0[2] - surface).abs();
        if apart.is_nan() {
            return Ok(f64::NAN);
        }
        largest = largest.max(apart);
    }
    Ok(largest)
}
