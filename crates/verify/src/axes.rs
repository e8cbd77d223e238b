//! How hard the axes work: velocity, acceleration and jerk of the played cubics.

use turnpath_core::toolpath::{Cubic, PathBlock};

/// One axis over a path, in its own unit (mm or rad) and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisMotion {
    /// Largest speed.
    pub max_velocity: f64,
    /// Largest acceleration.
    pub max_acceleration: f64,
    /// Largest jerk within segments; the steps of acceleration between them are not in it.
    pub max_jerk: f64,
    /// Time integral of the acceleration's square.
    square: f64,
    /// Time measured, s.
    time: f64,
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

    fn append(&mut self, next: &Self) {
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
            motion.c.see(&segment.c, segment.duration);
            motion.x.see(&segment.x, segment.duration);
            motion.z.see(&segment.z, segment.duration);
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
}
