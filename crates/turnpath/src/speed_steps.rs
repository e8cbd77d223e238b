//! The speed of C as a controller plays it that keeps it within a segment.

use turnpath_core::toolpath::ControlPoint;

/// The largest step of the speed of C along a path where each segment has its mean speed.
#[derive(Debug, Default)]
pub struct SpeedSteps {
    /// The last point, and the speed of C before it, rad/s.
    last: Option<(ControlPoint, f64)>,
    largest: f64,
}

impl SpeedSteps {
    /// Takes the next point.
    pub fn pass(&mut self, point: &ControlPoint) {
        // A path begins with the velocity of its first point.
        let mut speed = point.vc;
        if let Some((last, before)) = self.last {
            speed = (point.c - last.c) / (point.t - last.t);
            self.largest = self.largest.max((speed - before).abs());
        }
        self.last = Some((*point, speed));
    }

    /// The largest step of the speed of C so far, rad/s, with that to the velocity of the last point.
    pub fn largest(&self) -> f64 {
        let end = self.last.map(|(point, speed)| (point.vc - speed).abs());
        self.largest.max(end.unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// C = t² from rest, in steps of h: the mean speeds are h, 3h, 5h, … and end 1·h below the last one.
    #[test]
    fn a_c_that_accelerates_steps_by_its_acceleration_times_the_time_of_a_segment() {
        let h = 0.25;
        let mut steps = SpeedSteps::default();
        for k in 0..9 {
            let t = f64::from(k) * h;
            steps.pass(&ControlPoint {
                t,
                c: t * t,
                vc: 2.0 * t,
                ..ControlPoint::default()
            });
        }
        assert_eq!(steps.largest(), 2.0 * h);
    }
}
