//! How hard the axes work: velocity, acceleration and jerk of what is played.
//!
//! Straight segments have their acceleration in impulses at the control points, where a controller
//! blends from one rate to the next. What is told of them is the jump of the rate over the mean of
//! both segments' times: the least acceleration that a blend can do with, from one segment's
//! middle to the other's.

use turnpath_core::toolpath::{Cubic, PathBlock, SegmentShape};

/// One axis over a path, in its own unit (mm or rad) and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisMotion {
    /// Largest speed.
    pub max_velocity: f64,
    /// Largest acceleration; between straight segments that of the slowest blend.
    pub max_acceleration: f64,
    /// Largest jerk within segments; the steps of acceleration between them are not in it, so
    /// straight segments have none.
    pub max_jerk: f64,
    /// Time integral of the acceleration's square.
    square: f64,
    /// Time measured, s.
    time: f64,
    /// The first and the last straight segment, where there are such.
    outer: Option<[Straight; 2]>,
}

/// A straight segment of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Straight {
    rate: f64,
    duration: f64,
}

impl AxisMotion {
    /// Root of the mean square of the acceleration over time.
    pub fn rms_acceleration(&self) -> f64 {
        if self.time > 0.0 {
            (self.square / self.time).sqrt()
        } else {
            0.0
        }
    }

    fn see(&mut self, cubic: &Cubic, duration: f64) {
        let (first, last) = (cubic.bend(0.0), cubic.bend(1.0));
        let mut fastest = cubic.slope(0.0).abs().max(cubic.slope(1.0).abs());
        let turning = first / (first - last);
        if (0.0..1.0).contains(&turning) {
            fastest = fastest.max(cubic.slope(turning).abs());
        }
        let (once, twice) = (duration.recip(), (duration * duration).recip());
        self.max_velocity = self.max_velocity.max(fastest * once);
        self.max_acceleration = self
            .max_acceleration
            .max(first.abs().max(last.abs()) * twice);
        self.max_jerk = self.max_jerk.max(cubic.jerk().abs() * twice * once);
        let mean_square = (first * first + first * last + last * last) / 3.0;
        self.square += mean_square * twice * twice * duration;
        self.time += duration;
    }

    fn see_straight(&mut self, rise: f64, duration: f64) {
        let rate = rise / duration;
        let here = Straight { rate, duration };
        self.max_velocity = self.max_velocity.max(rate.abs());
        self.time += duration;
        self.join([here, here]);
    }

    /// Blends from the last straight segment so far into the first of those that follow.
    fn join(&mut self, [first, last]: [Straight; 2]) {
        let Some([begin, before]) = self.outer else {
            self.outer = Some([first, last]);
            return;
        };
        let blend = 0.5 * (before.duration + first.duration);
        let acceleration = (first.rate - before.rate) / blend;
        self.max_acceleration = self.max_acceleration.max(acceleration.abs());
        self.square += acceleration * acceleration * blend;
        self.outer = Some([begin, last]);
    }

    fn append(&mut self, next: &Self) {
        if let Some(straight) = next.outer {
            self.join(straight);
        }
        self.max_velocity = self.max_velocity.max(next.max_velocity);
        self.max_acceleration = self.max_acceleration.max(next.max_acceleration);
        self.max_jerk = self.max_jerk.max(next.max_jerk);
        self.square += next.square;
        self.time += next.time;
    }
}

/// All three axes over a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxesMotion {
    /// C in rad.
    pub c: AxisMotion,
    /// X in mm.
    pub x: AxisMotion,
    /// Z in mm.
    pub z: AxisMotion,
}

impl AxesMotion {
    /// The motion between neighbouring control points.
    pub fn of(points: &PathBlock) -> Self {
        let mut motion = Self::default();
        for segment in points.segments() {
            let axes = [
                (&mut motion.c, &segment.c),
                (&mut motion.x, &segment.x),
                (&mut motion.z, &segment.z),
            ];
            for (axis, played) in axes {
                match points.shape {
                    SegmentShape::Cubic => axis.see(played, segment.duration),
                    SegmentShape::Linear => axis.see_straight(played.slope(0.0), segment.duration),
                }
            }
        }
        motion
    }

    /// Puts the motion of the path's next stretch behind this.
    pub fn append(&mut self, next: &Self) {
        self.c.append(&next.c);
        self.x.append(&next.x);
        self.z.append(&next.z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::toolpath::ControlPoint;

    #[test]
    fn a_known_cubic_has_its_own_derivatives() {
        // z = t³ − t on 0 … 2: v from −1 to 11, turning at 0, a to 12, jerk 6.
        let point = |t: f64| ControlPoint {
            t,
            z: t * t * t - t,
            vz: 3.0 * t * t - 1.0,
            ..ControlPoint::default()
        };
        let mut points = PathBlock::default();
        points.push(point(0.0));
        points.push(point(2.0));
        let z = AxesMotion::of(&points).z;
        assert!((z.max_velocity - 11.0).abs() < 1e-12);
        assert!((z.max_acceleration - 12.0).abs() < 1e-12);
        assert!((z.max_jerk - 6.0).abs() < 1e-12);
        assert!((z.rms_acceleration() - 48f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn straight_segments_have_the_blends_acceleration_also_where_stretches_join() {
        let polygon = |points: &[(f64, f64)]| {
            let mut block = PathBlock {
                shape: SegmentShape::Linear,
                ..PathBlock::default()
            };
            for (t, z) in points {
                block.push(ControlPoint {
                    t: *t,
                    z: *z,
                    vz: 1e9,
                    ..ControlPoint::default()
                });
            }
            AxesMotion::of(&block)
        };
        let points = [(0.0, 0.0), (1.0, 2.0), (4.0, 2.0), (5.0, -1.0)];
        let whole = polygon(&points);
        // Rates 2, 0, −3; blends of 2 s each: 1 and 1.5 mm/s².
        assert_eq!(whole.z.max_velocity, 3.0);
        assert_eq!(whole.z.max_acceleration, 1.5);
        assert_eq!(whole.z.max_jerk, 0.0);
        let mean_square: f64 = (1.0 * 2.0 + 2.25 * 2.0) / 5.0;
        assert!((whole.z.rms_acceleration() - mean_square.sqrt()).abs() < 1e-15);
        for joint in [1, 2] {
            let mut parts = AxesMotion::default();
            parts.append(&polygon(&points[..=joint]));
            parts.append(&polygon(&points[joint..]));
            assert_eq!(parts, whole);
        }
    }
}
