//! The instants of a batch of segments: the played position and the first touch at each.

use turnpath_core::toolpath::Segment;
use turnpath_core::{Result, tally, within_turn};

use crate::touch::{FirstTouch, Touch};

/// Instants of each segment at which the played position is compared, including its start and its
/// middle. The error of a cubic has one maximum over the segment, or a few. The largest of 16
/// samples misses the top of a maximum by up to 1 %, the parabola through that sample and its
/// neighbours by 0.1 %.
pub const INSTANTS: usize = 16;
/// Segments that are played back in one batch.
pub(crate) const BATCH: usize = 64;

/// The instants of a batch of segments. Its memory is used again for the next batch.
#[derive(Default)]
pub(crate) struct InstantBatch {
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    touches: Vec<Touch>,
}

impl InstantBatch {
    /// Plays segments, and finds the first touch at each instant.
    pub fn play(&mut self, batch: &[Segment], touch: &FirstTouch) -> Result<()> {
        for column in [&mut self.theta, &mut self.x, &mut self.z] {
            column.clear();
        }
        for segment in batch {
            for k in 0..INSTANTS {
                let s = k as f64 / INSTANTS as f64;
                let c = segment.c.value(s);
                self.theta.push(within_turn(c));
                self.x.push(segment.x.value(s));
                self.z.push(segment.z.value(s));
            }
        }
        tally::INSTANTS.add(self.theta.len());
        touch.find(&self.theta, &self.x, &mut self.touches)
    }

    /// Played − true Z at the instants of one segment of the batch, mm.
    pub fn errors(&self, segment: usize) -> [f64; INSTANTS] {
        std::array::from_fn(|k| {
            let instant = segment * INSTANTS + k;
            self.z[instant] - self.touches[instant].z
        })
    }

    /// Played X at one instant of one segment of the batch, mm.
    pub fn x(&self, segment: usize, instant: usize) -> f64 {
        self.x[segment * INSTANTS + instant]
    }

    /// The first touch at each instant, one segment after the other.
    pub fn touches(&self) -> &[Touch] {
        &self.touches
    }
}
