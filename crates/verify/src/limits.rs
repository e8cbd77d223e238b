//! A path's motion against a machine's limits, and how fast it can be played within them.
//!
//! A path's points have the same C at every speed of the spindle, and its cubics scale with time.
//! So velocity, acceleration and jerk grow with the first, second and third power of the speed, and
//! the highest speed follows from one measured path. It is not exact where the path itself depends
//! on the speed: with a law that keeps X within a limit, or with points on a controller's time
//! steps.

use turnpath_core::{Axis, Derivative, Limit, Machine, Scalar};

use crate::axes::{AxesMotion, Peak};
use crate::certain_motion::CertainMotion;

/// From this part of an amount on, what is certain of it counts as all of it: limits are judged to a thousandth.
const NEARLY_ALL: f64 = 0.999;

/// One limit and the largest amount on the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitFigure {
    /// What the machine can do.
    pub limit: Limit,
    /// The largest amount; `None` where no such figure exists: the jerk of straight segments.
    pub peak: Option<Peak>,
    /// What is certain of it; `None` where nearly all of it is.
    pub certain: Option<Peak>,
}

/// The highest speed at which a path can be played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighestSpeed {
    /// The factor by which the whole motion can be faster.
    pub factor: f64,
    /// Mean speed of C, rad/s.
    pub speed: f64,
    /// The limit that is reached at this speed.
    pub bound_by: Limit,
}

impl LimitFigure {
    /// The largest amount over the limit, as far as it is certain; 0 where there is no figure.
    pub fn ratio(&self) -> f64 {
        let peak = self.peak.map(|peak| self.certain.unwrap_or(peak));
        peak.map_or(0.0, |peak| peak.amount / self.limit.value)
    }

    /// The factor by which the speed can grow until the limit is reached. The n-th derivative in
    /// time grows with the n-th power of the speed, since the positions of the axes depend on C
    /// alone. Infinite where nothing moves.
    pub fn speed_factor(&self) -> f64 {
        let order = f64::from(self.limit.derivative.order());
        Scalar::powf(self.ratio().recip(), order.recip())
    }
}

impl AxesMotion {
    /// Each limit of the machine with the path's largest amount. `certain` is what is certain of the motion, if
    /// that was measured.
    pub fn against(&self, machine: &Machine, certain: Option<&CertainMotion>) -> Vec<LimitFigure> {
        let figure = |limit: Limit| {
            let peak = self.peak(limit.axis, limit.derivative);
            let certain = certain.map(|motion| motion.peak(limit.axis, limit.derivative));
            LimitFigure {
                limit,
                peak,
                certain: certain.filter(|certain| {
                    peak.is_some_and(|peak| certain.amount < NEARLY_ALL * peak.amount)
                }),
            }
        };
        machine.limits().map(figure).collect()
    }

    /// The highest speed of the spindle at which this motion holds all limits, if nothing else
    /// about the path changes. Leads do not scale in this way: they keep their clearance and their
    /// own gentle limits at every speed. `None` if no limit bounds the speed.
    pub fn highest_speed(
        &self,
        machine: &Machine,
        certain: Option<&CertainMotion>,
    ) -> Option<HighestSpeed> {
        let figures = self.against(machine, certain).into_iter();
        let factors = figures.map(|figure| (figure.speed_factor(), figure.limit));
        let least = factors.min_by(|one, other| one.0.total_cmp(&other.0));
        least
            .map(|(factor, bound_by)| HighestSpeed {
                factor,
                speed: factor * self.c.mean_velocity().abs(),
                bound_by,
            })
            .filter(|highest| highest.speed.is_finite())
    }

    /// The largest amount of a derivative; `None` for the jerk of straight segments.
    pub fn peak(&self, axis: Axis, derivative: Derivative) -> Option<Peak> {
        let motion = match axis {
            Axis::X => &self.x,
            Axis::Z => &self.z,
            Axis::C => &self.c,
        };
        match derivative {
            Derivative::Velocity => Some(motion.velocity),
            Derivative::Acceleration => Some(motion.acceleration),
            Derivative::Jerk => Some(motion.jerk).filter(|_| !motion.is_straight()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::toolpath::{ControlPoint, PathBlock, SegmentShape};

    /// z = t³ − t on 0 … 2 while C turns at 3 rad/s, the whole motion `speed` times as fast.
    fn played(speed: f64, shape: SegmentShape) -> AxesMotion {
        let point = |t: f64| ControlPoint {
            t: t / speed,
            c: 3.0 * t,
            vc: 3.0 * speed,
            z: t * t * t - t,
            vz: (3.0 * t * t - 1.0) * speed,
            ..ControlPoint::default()
        };
        let mut points = PathBlock {
            shape,
            ..PathBlock::default()
        };
        points.push(point(0.0));
        points.push(point(2.0));
        AxesMotion::of(&points)
    }

    fn machine(axis: Axis, derivative: Derivative, value: f64) -> Machine {
        let mut machine = Machine::default();
        *machine.limit_mut(axis, derivative) = Some(value);
        machine
    }

    #[test]
    fn at_the_highest_speed_the_limit_is_just_reached() {
        // Velocity 11, acceleration 12, jerk 6 at 3 rad/s.
        for (axis, derivative, limit) in [
            (Axis::Z, Derivative::Velocity, 22.0),
            (Axis::Z, Derivative::Acceleration, 3.0),
            (Axis::Z, Derivative::Jerk, 48.0),
            (Axis::C, Derivative::Velocity, 4.5),
        ] {
            let machine = machine(axis, derivative, limit);
            let highest = played(1.0, SegmentShape::Cubic).highest_speed(&machine, None);
            let highest = highest.expect("a bound");
            assert_eq!(highest.bound_by.axis, axis);
            let again = played(highest.speed / 3.0, SegmentShape::Cubic);
            let ratio = again.against(&machine, None)[0].ratio();
            assert!((ratio - 1.0).abs() < 1e-12, "{derivative:?}: {ratio}");
        }
    }

    #[test]
    fn the_tightest_of_several_limits_for_its_order_binds() {
        let mut machine = machine(Axis::Z, Derivative::Velocity, 5.5);
        machine.z.acceleration = Some(6.0);
        machine.z.jerk = Some(3.0);
        // Factors 1/2, 1/√2, 1/∛2.
        let highest = played(1.0, SegmentShape::Cubic).highest_speed(&machine, None);
        let highest = highest.expect("a bound");
        assert_eq!(highest.bound_by.derivative, Derivative::Velocity);
        assert!((highest.speed - 1.5).abs() < 1e-12);
    }

    #[test]
    fn nothing_binds_where_there_is_no_limit_no_motion_or_no_figure() {
        let cubic = played(1.0, SegmentShape::Cubic);
        assert_eq!(cubic.highest_speed(&Machine::default(), None), None);
        let at_rest = machine(Axis::X, Derivative::Acceleration, 1.0);
        assert_eq!(cubic.highest_speed(&at_rest, None), None);
        assert_eq!(cubic.against(&at_rest, None)[0].ratio(), 0.0);
        let jerk = machine(Axis::Z, Derivative::Jerk, 1e-3);
        let straight = played(1.0, SegmentShape::Linear);
        assert_eq!(straight.against(&jerk, None)[0].peak, None);
        assert_eq!(straight.highest_speed(&jerk, None), None);
    }
}
