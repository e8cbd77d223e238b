//! The instants of a batch of segments: the played position and the first touch at each.

use std::ops::Range;

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::{Cubic, PathBlock, SegmentShape};
use turnpath_core::{Result, tally, within_turns};

use crate::touch::{FirstTouch, Touch, TouchBuffers};

/// Instants of each segment at which the played position is compared, including its start and its
/// middle. The error of a cubic has one maximum over the segment, or a few. The largest of 16
/// samples misses the top of a maximum by up to 1 %, the parabola through that sample and its
/// neighbours by 0.1 %.
pub const INSTANTS: usize = 16;
/// Segments that are played back in one batch.
pub(crate) const BATCH: usize = 64;

/// The instants of a batch of segments: the first instant of all segments, the second one of all
/// segments, and so on, so that neighbouring segments are side by side in vector registers. Its memory
/// is used again for the next batch.
#[derive(Default)]
pub(crate) struct InstantBatch {
    segments: usize,
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    errors: Vec<f64>,
    buffers: TouchBuffers,
}

impl InstantBatch {
    /// Plays segments of a block, at most [`BATCH`], and finds the first touch at each instant.
    pub fn play(
        &mut self,
        points: &PathBlock,
        segments: Range<usize>,
        touch: &FirstTouch,
    ) -> Result<()> {
        self.segments = segments.len();
        let axes = [
            (&points.c, &points.vc, &mut self.theta),
            (&points.x, &points.vx, &mut self.x),
            (&points.z, &points.vz, &mut self.z),
        ];
        let ends = segments.start..segments.end + 1;
        for (position, velocity, played) in axes {
            played.resize(self.segments * INSTANTS, 0.0);
            in_widest(AxisPlayback {
                shape: points.shape,
                times: &points.t[ends.clone()],
                positions: &position[ends.clone()],
                velocities: &velocity[ends.clone()],
                played,
            });
        }
        within_turns(&mut self.theta);
        tally::INSTANTS.add(self.theta.len());
        touch.find_in(&self.theta, &self.x, &mut self.buffers)?;
        self.errors.resize(self.z.len(), 0.0);
        in_widest(Differences(
            &self.z,
            &self.buffers.touches.z,
            &mut self.errors,
        ));
        Ok(())
    }

    /// Played − true Z of all segments, mm: a chunk for each instant.
    pub fn each_instant(&self) -> impl Iterator<Item = &[f64]> {
        self.errors.chunks_exact(self.segments.max(1))
    }

    /// Played − true Z at the instants of one segment of the batch, mm.
    pub fn errors(&self, segment: usize) -> [f64; INSTANTS] {
        self.of_segment(&self.errors, segment)
    }

    /// The radii of the contacts at the instants of one segment of the batch, mm.
    pub fn feet(&self, segment: usize) -> [f64; INSTANTS] {
        self.of_segment(&self.buffers.touches.foot, segment)
    }

    /// The instants of one segment of a column.
    fn of_segment(&self, column: &[f64], segment: usize) -> [f64; INSTANTS] {
        std::array::from_fn(|instant| column[self.place(segment, instant)])
    }

    /// The errors at an instant and its neighbours; `None` at the last one and the first one.
    pub fn around(&self, segment: usize, instant: usize) -> Option<[f64; 3]> {
        let is_inside = (1..INSTANTS - 1).contains(&instant);
        is_inside.then(|| {
            [instant - 1, instant, instant + 1].map(|k| self.errors[self.place(segment, k)])
        })
    }

    /// Played X at one instant of one segment of the batch, mm.
    pub fn x(&self, segment: usize, instant: usize) -> f64 {
        self.x[self.place(segment, instant)]
    }

    /// The first touches at the instants of one segment of the batch.
    pub fn touches(&self, segment: usize) -> [Touch; INSTANTS] {
        std::array::from_fn(|instant| self.buffers.touches.at(self.place(segment, instant)))
    }

    fn place(&self, segment: usize, instant: usize) -> usize {
        instant * self.segments + segment
    }
}

/// The loop over the segments of a batch for one axis.
struct AxisPlayback<'a> {
    shape: SegmentShape,
    /// Of both ends of all segments.
    times: &'a [f64],
    positions: &'a [f64],
    velocities: &'a [f64],
    /// The played positions, a chunk for each instant.
    played: &'a mut [f64],
}

impl Loop for AxisPlayback<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.times.len().saturating_sub(1).min(BATCH);
        let firsts = [self.times, self.positions, self.velocities].map(|column| &column[..count]);
        let lasts = [self.times, self.positions, self.velocities].map(|column| &column[1..=count]);
        let [mut a, mut b, mut c, mut d] = [[0.0; BATCH]; 4];
        for i in 0..count {
            let ([t0, p0, v0], [t1, p1, v1]) = (firsts.map(|f| f[i]), lasts.map(|l| l[i]));
            let cubic = match self.shape {
                SegmentShape::Cubic => Cubic::hermite(p0, v0, p1, v1, t1 - t0),
                SegmentShape::Linear => Cubic::straight(p0, p1),
            };
            [a[i], b[i], c[i], d[i]] = cubic.0;
        }
        for (instant, played) in self.played.chunks_exact_mut(count.max(1)).enumerate() {
            let s = instant as f64 / INSTANTS as f64;
            for (i, played) in played.iter_mut().enumerate().take(BATCH) {
                *played = Cubic([a[i], b[i], c[i], d[i]]).value(s);
            }
        }
    }
}

/// The loop over played − true Z.
struct Differences<'a>(&'a [f64], &'a [f64], &'a mut [f64]);

impl Loop for Differences<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(played, touched, errors) = self;
        for ((error, played), touched) in errors.iter_mut().zip(played).zip(touched) {
            *error = played - touched;
        }
    }
}
