//! How many segments a controller has to read in a second.

use std::collections::VecDeque;

use turnpath_core::DEG;
use turnpath_core::toolpath::ControlPoint;
use turnpath_post::ProgramError;

/// The time over which segments are counted, s. Controllers read ahead, so a few short segments in a row
/// cost nothing; how far they read is not known of most.
const WINDOW: f64 = 1.0;

/// Counts the segments that end within a second of each other.
#[derive(Debug, Default)]
pub struct SegmentRate {
    /// The ends of the last second.
    times: VecDeque<f64>,
    /// The most segments in a second, and the point that ends it.
    most: u64,
    at: ControlPoint,
}

impl SegmentRate {
    /// Takes the next point.
    pub fn pass(&mut self, point: &ControlPoint) {
        self.times.push_back(point.t);
        while self
            .times
            .front()
            .is_some_and(|time| *time <= point.t - WINDOW)
        {
            self.times.pop_front();
        }
        let count = self.times.len() as u64;
        if count > self.most {
            (self.most, self.at) = (count, *point);
        }
    }

    /// Counts the segments of a second from a sample that is shorter. The path goes on like the sample for
    /// `times` its time. `without_border` is the number of segments that it would have without its end, over
    /// those that it has: the end cuts the sampler's last step off.
    pub fn extrapolate(&mut self, times: f64, without_border: f64) {
        let (Some(first), Some(last)) = (self.times.front(), self.times.back()) else {
            return;
        };
        let (passed, segments) = (last - first, self.times.len() - 1);
        let time = WINDOW.min(passed * times);
        if passed > 0.0 && passed < time {
            let expected = segments as f64 * without_border * time / passed;
            self.most = self.most.max(expected as u64);
        }
    }

    /// Refuses a path with more segments in a second than a controller reads.
    ///
    /// # Errors
    /// When there are more: how many, and where.
    pub fn within(&self, most: Option<f64>) -> Result<(), ProgramError> {
        match most.filter(|most| self.most as f64 > *most) {
            None => Ok(()),
            Some(most) => Err(ProgramError::FastSegments {
                segments: self.most,
                most,
                t: self.at.t,
                c_deg: self.at.c / DEG,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_that_is_shorter_than_a_second_counts_as_what_it_stands_for() {
        // Ten steps of 19 ms, and the first 5 ms of one that the end cuts off.
        let ends = (0..11)
            .map(|number| 0.019 * f64::from(number))
            .chain([0.195]);
        for (times, expected) in [(1.0, 12), (2.0, 20), (4.0, 41), (100.0, 52)] {
            let mut rate = SegmentRate::default();
            for end in ends.clone() {
                rate.pass(&ControlPoint {
                    t: 3.0 + end,
                    ..ControlPoint::default()
                });
            }
            rate.extrapolate(times, (10.0 + 5.0 / 19.0) / 11.0);
            assert_eq!(rate.most, expected, "{times}");
        }
    }

    #[test]
    fn the_busiest_second_is_found_with_its_place() {
        let mut rate = SegmentRate::default();
        // Ten in a second, then forty in a second, then ten again.
        let steps = (0..20)
            .map(|_| 0.1)
            .chain((0..60).map(|_| 0.025))
            .chain((0..20).map(|_| 0.1));
        let mut t = 0.0;
        for step in steps {
            t += step;
            rate.pass(&ControlPoint {
                t,
                c: t * DEG,
                ..ControlPoint::default()
            });
        }
        assert!(rate.within(None).is_ok() && rate.within(Some(41.0)).is_ok());
        let error = rate.within(Some(30.0)).unwrap_err();
        let ProgramError::FastSegments {
            segments, t, c_deg, ..
        } = error
        else {
            panic!("{error}");
        };
        assert!((40..=41).contains(&segments), "{segments}");
        assert!((2.9..3.6).contains(&t) && (c_deg - t).abs() < 1e-9, "{t}");
    }
}
