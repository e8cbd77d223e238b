//! The speed of C as a controller plays it that keeps it within a segment.

use turnpath_core::toolpath::{ControlPoint, Section};
use turnpath_post::{ReadCount, ReadError, ReadPath};

/// Reads a path, and finds the largest step of the speed of C where each segment has its mean speed.
pub struct SpeedSteps<'a> {
    reader: &'a mut (dyn ReadPath + Send),
    /// The last point, and the speed of C before it, rad/s.
    last: Option<(ControlPoint, f64)>,
    largest: f64,
}

impl<'a> SpeedSteps<'a> {
    /// A path that was not begun.
    pub fn new(reader: &'a mut (dyn ReadPath + Send)) -> Self {
        Self {
            reader,
            last: None,
            largest: 0.0,
        }
    }

    /// The largest step of the speed of C so far, rad/s, with that to the velocity of the last point.
    pub fn largest(&self) -> f64 {
        let end = self.last.map(|(point, speed)| (point.vc - speed).abs());
        self.largest.max(end.unwrap_or_default())
    }
}

impl ReadPath for SpeedSteps<'_> {
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let next = self.reader.next_point()?;
        if let Some((point, _)) = next {
            // A path begins with the velocity of its first point.
            let mut speed = point.vc;
            if let Some((last, before)) = self.last {
                speed = (point.c - last.c) / (point.t - last.t);
                self.largest = self.largest.max((speed - before).abs());
            }
            self.last = Some((point, speed));
        }
        Ok(next)
    }

    fn read_count(&self) -> &ReadCount {
        self.reader.read_count()
    }

    fn read_count_mut(&mut self) -> &mut ReadCount {
        self.reader.read_count_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Points(Vec<ControlPoint>, ReadCount);

    impl ReadPath for Points {
        fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
            Ok(self.0.pop().map(|point| (point, Section::Cutting)))
        }

        fn read_count(&self) -> &ReadCount {
            &self.1
        }

        fn read_count_mut(&mut self) -> &mut ReadCount {
            &mut self.1
        }
    }

    /// C = t² from rest, in steps of h: the mean speeds are h, 3h, 5h, … and end 1·h below the last one.
    #[test]
    fn a_c_that_accelerates_steps_by_its_acceleration_times_the_time_of_a_segment() {
        let h = 0.25;
        let point = |k: u32| {
            let t = f64::from(k) * h;
            ControlPoint {
                t,
                c: t * t,
                vc: 2.0 * t,
                ..ControlPoint::default()
            }
        };
        let mut points = Points((0..9).rev().map(point).collect(), ReadCount::default());
        let mut steps = SpeedSteps::new(&mut points);
        while steps.next_point().unwrap().is_some() {}
        assert_eq!(steps.largest(), 2.0 * h);
    }
}
