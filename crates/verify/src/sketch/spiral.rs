//! Places of the tool along the path: a sample that thins out as the path grows.

use turnpath_core::toolpath::PathBlock;

/// Most samples of a path: a picture shows no more, and twice as many fill its file.
const MOST: usize = 12_000;

/// A place of the tool, with the largest error from there to the next sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpiralSample {
    /// C, unwrapped, rad.
    pub c: f64,
    /// X of the path, mm.
    pub x: f64,
    /// Largest |played − true|, mm.
    pub error: f64,
}

/// The segments of a block as samples.
pub(super) fn samples(points: &PathBlock, per_segment: &[f64]) -> Vec<SpiralSample> {
    let places = points.c.iter().zip(&points.x).zip(per_segment);
    let sample = |((c, x), error): ((&f64, &f64), &f64)| SpiralSample {
        c: *c,
        x: *x,
        error: *error,
    };
    places.map(sample).collect()
}

/// Every so many segments of a path.
#[derive(Debug, Clone)]
pub(super) struct Spiral {
    samples: Vec<SpiralSample>,
    /// Segments from one sample to the next.
    stride: u64,
    /// Segments so far.
    segments: u64,
}

impl Default for Spiral {
    fn default() -> Self {
        Self {
            samples: Vec::new(),
            stride: 1,
            segments: 0,
        }
    }
}

impl Spiral {
    /// Appends the segments of the path's next block.
    pub fn append(&mut self, next: &[SpiralSample]) {
        for segment in next {
            let begins = self.segments.is_multiple_of(self.stride);
            self.segments += 1;
            match self.samples.last_mut().filter(|_| !begins) {
                Some(last) => last.error = last.error.max(segment.error),
                None => self.samples.push(*segment),
            }
            if self.samples.len() > MOST {
                self.thin_out();
            }
        }
    }

    /// Joins every two neighbouring samples.
    fn thin_out(&mut self) {
        self.samples = self.samples.chunks(2).map(joined).collect();
        self.stride *= 2;
    }

    /// The samples so far.
    pub fn samples(&self) -> Vec<SpiralSample> {
        self.samples.clone()
    }
}

/// The first of neighbouring samples, with the largest error of all.
fn joined(samples: &[SpiralSample]) -> SpiralSample {
    let error = samples
        .iter()
        .fold(0.0, |most: f64, one| most.max(one.error));
    SpiralSample {
        error,
        ..samples[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(count: u32) -> Vec<SpiralSample> {
        let sample = |i: u32| SpiralSample {
            c: f64::from(i),
            x: 1.0,
            error: f64::from(i * 7919 % 1000),
        };
        (0..count).map(sample).collect()
    }

    fn thinned(blocks: &[&[SpiralSample]]) -> Spiral {
        let mut spiral = Spiral::default();
        blocks.iter().for_each(|block| spiral.append(block));
        spiral
    }

    #[test]
    fn a_short_path_has_all_its_segments() {
        let path = path(500);
        assert_eq!(thinned(&[&path]).samples(), path);
    }

    #[test]
    fn a_long_path_is_thinned_evenly_and_keeps_every_peak() {
        let path = path(100_001);
        let spiral = thinned(&[&path]);
        let (samples, stride) = (spiral.samples(), spiral.stride as usize);
        assert_eq!((samples.len(), stride), (6251, 16));
        for (sample, segments) in samples.iter().zip(path.chunks(stride)) {
            let most = segments.iter().map(|one| one.error).fold(0.0, f64::max);
            assert_eq!((sample.c, sample.error), (segments[0].c, most));
        }
    }

    #[test]
    fn the_samples_do_not_depend_on_the_blocks() {
        let path = path(30_007);
        let whole = thinned(&[&path]).samples();
        let (one, rest) = path.split_at(12_001);
        let (two, three) = rest.split_at(5);
        assert_eq!(thinned(&[one, two, three]).samples(), whole);
    }
}
