//! Places of the tool along the path: a sample that thins out as the path grows.
//!
//! A sample stands for 2^k neighbouring segments. Always the first of them would fall on the same
//! angles of every turn where the turn has an even number of segments, and a spiral would look like a
//! star. So each halving takes the first or the second by a bit of a hash.

use turnpath_core::toolpath::PathBlock;

/// Most samples of a path: a picture shows no more, and twice as many fill its file.
const MOST: usize = 12_000;
/// 2⁶⁴ times the golden ratio: its multiples spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A place of the tool, with the largest error of the segments that it stands for.
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
#[derive(Debug, Clone, Default)]
pub(super) struct Spiral {
    samples: Vec<SpiralSample>,
    /// How often neighbours were joined: a sample stands for 2 to this power segments.
    halvings: u32,
    /// Segments so far.
    segments: u64,
}

impl Spiral {
    /// Appends the segments of the path's next block.
    pub fn append(&mut self, next: &[SpiralSample]) {
        for segment in next {
            let number = self.segments;
            self.segments += 1;
            let group = number >> self.halvings;
            match self
                .samples
                .last_mut()
                .filter(|_| number != group << self.halvings)
            {
                None => self.samples.push(*segment),
                Some(last) => {
                    let error = last.error.max(segment.error);
                    let is_chosen = number == chosen(group, self.halvings);
                    *last = if is_chosen { *segment } else { *last };
                    last.error = error;
                }
            }
            if self.samples.len() > MOST {
                self.thin_out();
            }
        }
    }

    /// Joins every two neighbouring samples.
    fn thin_out(&mut self) {
        let pairs = (0_u64..).zip(self.samples.chunks(2));
        self.samples = pairs.map(|(group, pair)| joined(group, pair)).collect();
        self.halvings += 1;
    }

    /// The samples so far.
    pub fn samples(&self) -> Vec<SpiralSample> {
        self.samples.clone()
    }
}

/// Which of the two halves of a group is its sample, 0 or 1: the highest bit of a multiplicative hash.
fn half(group: u64) -> u64 {
    group.wrapping_mul(GOLDEN) >> (u64::BITS - 1)
}

/// The number of the segment that is the sample of a group of 2^`halvings`.
fn chosen(group: u64, halvings: u32) -> u64 {
    (0..halvings).fold(group, |group, _| 2 * group + half(group))
}

/// One of two neighbouring samples, with the larger error of both.
fn joined(group: u64, pair: &[SpiralSample]) -> SpiralSample {
    let error = pair.iter().fold(0.0, |most: f64, one| most.max(one.error));
    let of_group = pair.get(half(group) as usize).unwrap_or(&pair[0]);
    SpiralSample { error, ..*of_group }
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
        let (samples, stride) = (spiral.samples(), 1 << spiral.halvings);
        assert_eq!((samples.len(), stride), (6251, 16));
        for (sample, segments) in samples.iter().zip(path.chunks(stride)) {
            let most = segments.iter().map(|one| one.error).fold(0.0, f64::max);
            assert!(segments.iter().any(|one| one.c == sample.c));
            assert_eq!(sample.error, most);
        }
    }

    #[test]
    fn the_samples_lie_at_all_angles_of_turns_of_even_steps() {
        for steps in [4, 8, 10, 40, 64] {
            let samples = thinned(&[&path(100_000)]).samples();
            let mut counts = vec![0; steps];
            for sample in &samples {
                counts[sample.c as usize % steps] += 1;
            }
            let mean = samples.len() / steps;
            assert!(counts.iter().all(|count| 2 * count > mean), "{counts:?}");
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
