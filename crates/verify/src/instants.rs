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
/// Segments that are played back in one batch, at most.
pub(crate) const BATCH: usize = 128;
/// Segments whose cubics are played side by side.
const TOGETHER: usize = 8;

/// The batches of some segments, of nearly one size: a short one at the end would fill no register.
pub(crate) fn batches(segments: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let count = segments.len();
    let size = count.div_ceil(count.div_ceil(BATCH).max(1)).max(1);
    let firsts = segments.clone().step_by(size);
    firsts.map(move |first| first..segments.end.min(first + size))
}

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
    /// Played − true Z at the ends of all segments, mm: at the first control point, the second, and so on.
    end_errors: Vec<f64>,
    end_theta: Vec<f64>,
    end_buffers: TouchBuffers,
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
        self.find_touches(points, ends, touch)?;
        self.errors.resize(self.z.len(), 0.0);
        in_widest(Differences(
            &self.z,
            &self.buffers.touches.z,
            &mut self.errors,
        ));
        Ok(())
    }

    /// Finds the touches at the ends of all segments, and from them those at all instants.
    fn find_touches(
        &mut self,
        points: &PathBlock,
        ends: Range<usize>,
        touch: &FirstTouch,
    ) -> Result<()> {
        self.end_theta.clear();
        self.end_theta.extend_from_slice(&points.c[ends.clone()]);
        within_turns(&mut self.end_theta);
        let end_x = &points.x[ends.clone()];
        touch.find_in(&self.end_theta, end_x, &mut self.end_buffers)?;
        let touches = &self.end_buffers.touches;
        self.end_errors.resize(end_x.len(), 0.0);
        in_widest(Differences(
            &points.z[ends],
            &touches.z,
            &mut self.end_errors,
        ));
        // Each segment begins at the first of its ends.
        let known = (touches, self.segments);
        touch.find_along(&self.theta, &self.x, known, &mut self.buffers)
    }

    /// Played − true Z of all segments, mm: a chunk for each instant.
    pub fn each_instant(&self) -> impl Iterator<Item = &[f64]> {
        self.errors.chunks_exact(self.segments.max(1))
    }

    /// The errors of all segments at 17 times: a chunk for each instant, and one for the ends.
    pub fn each_time(&self) -> impl Iterator<Item = &[f64]> {
        self.each_instant().chain(self.end_errors.get(1..))
    }

    /// Played − true Z at both ends of one segment of the batch, mm.
    pub fn end_errors(&self, segment: usize) -> [f64; 2] {
        [self.end_errors[segment], self.end_errors[segment + 1]]
    }

    /// Played − true Z at one instant of one segment of the batch, mm.
    pub fn error(&self, segment: usize, instant: usize) -> f64 {
        self.errors[self.place(segment, instant)]
    }

    /// Played − true Z at one of 17 times of one segment of the batch, mm: the instants, and the end.
    pub fn error_at(&self, segment: usize, time: usize) -> f64 {
        match time {
            INSTANTS => self.end_errors(segment)[1],
            _ => self.error(segment, time),
        }
    }

    /// The radius of the contact at one instant of one segment of the batch, mm.
    pub fn foot(&self, segment: usize, instant: usize) -> f64 {
        self.buffers.touches.foot[self.place(segment, instant)]
    }

    /// The errors at an instant and its neighbours; `None` at the last one and the first one.
    pub fn around(&self, segment: usize, instant: usize) -> Option<[f64; 3]> {
        let is_inside = (1..INSTANTS - 1).contains(&instant);
        is_inside.then(|| [instant - 1, instant, instant + 1].map(|k| self.error(segment, k)))
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
    fn call(mut self) {
        let count = self.times.len().saturating_sub(1);
        let rest = count - count % TOGETHER;
        for first in (0..rest).step_by(TOGETHER) {
            self.play::<TOGETHER>(count, first);
        }
        for first in rest..count {
            self.play::<1>(count, first);
        }
    }
}

impl AxisPlayback<'_> {
    /// Plays `N` of `count` segments side by side: their cubics stay in registers for all instants.
    #[inline(always)]
    fn play<const N: usize>(&mut self, count: usize, first: usize) {
        let firsts =
            [self.times, self.positions, self.velocities].map(|column| &column[first..first + N]);
        let lasts = [self.times, self.positions, self.velocities]
            .map(|column| &column[first + 1..first + 1 + N]);
        let [mut a, mut b, mut c, mut d] = [[0.0; N]; 4];
        for i in 0..N {
            let ([t0, p0, v0], [t1, p1, v1]) = (firsts.map(|f| f[i]), lasts.map(|l| l[i]));
            let cubic = match self.shape {
                SegmentShape::Cubic => Cubic::hermite(p0, v0, p1, v1, t1 - t0),
                SegmentShape::Linear => Cubic::straight(p0, p1),
            };
            [a[i], b[i], c[i], d[i]] = cubic.0;
        }
        for (instant, played) in self.played.chunks_exact_mut(count).enumerate() {
            let s = instant as f64 / INSTANTS as f64;
            let played = &mut played[first..first + N];
            for i in 0..N {
                played[i] = Cubic([a[i], b[i], c[i], d[i]]).value(s);
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

#[cfg(test)]
mod tests;
