//! How fast a lead may move the axes.

use turnpath_core::{Axis, Derivative, Machine, Scalar};
use turnpath_verify::{AxesMotion, AxisMotion};

/// Limits of one axis, in rad or mm and s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisLimits {
    /// Largest speed.
    pub velocity: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest jerk, where there is such a limit.
    pub jerk: Option<f64>,
}

/// How much of the motion that follows the part a lead may add to its limits. X overshoots the cut
/// a little, where slopes may be larger.
const FOLLOWING: f64 = 1.25;
/// By how much a lead may exceed the cut where the cut itself exceeds a limit of the machine.
const AT_THE_LIMIT: f64 = 1.02;
/// A machine's limit counts as kept up to this part of it: half of what a verdict allows.
const KEPT: f64 = 1.0005;

/// Limits of the three axes. A lead may exceed them by the motion that follows the part beside the
/// join, as the cut does it, and by a quarter more of that motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadLimits {
    /// C, rad and s.
    pub c: AxisLimits,
    /// X, mm and s.
    pub x: AxisLimits,
    /// Z, mm and s.
    pub z: AxisLimits,
    /// Limits of the machine. A lead may exceed them only where the cut itself does.
    pub machine: Machine,
}

impl Default for LeadLimits {
    /// Gentle limits for any machine of the kind: an air-bearing spindle reaches 500 rpm within
    /// 1.6 s, and a slide moves at a tenth of its capacity.
    fn default() -> Self {
        let axis = |velocity, acceleration| AxisLimits {
            velocity,
            acceleration,
            jerk: None,
        };
        Self {
            c: axis(f64::INFINITY, 50.0),
            x: axis(10.0, 100.0),
            z: axis(20.0, 200.0),
            machine: Machine::default(),
        }
    }
}

impl LeadLimits {
    /// Gentle limits that are also within those of a machine.
    pub fn within(machine: Machine) -> Self {
        let gentle = Self::default();
        let tighter = |gentle: AxisLimits, axis| {
            let least = |own: f64, of| machine.limit(axis, of).map_or(own, |limit| own.min(limit));
            AxisLimits {
                velocity: least(gentle.velocity, Derivative::Velocity),
                acceleration: least(gentle.acceleration, Derivative::Acceleration),
                jerk: machine.limit(axis, Derivative::Jerk),
            }
        };
        Self {
            c: tighter(gentle.c, Axis::C),
            x: tighter(gentle.x, Axis::X),
            z: tighter(gentle.z, Axis::Z),
            machine,
        }
    }
}

/// How a lead is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadSettings {
    /// By how much the path rests above the highest point of the part, mm.
    pub clearance: f64,
    /// How fast it may move the axes.
    pub limits: LeadLimits,
}

/// Largest derivatives of a step from 0 to 1 within a time of 1.
#[derive(Debug, Clone, Copy)]
pub struct StepShape {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

/// The step 10s³ − 15s⁴ + 6s⁵.
pub const QUINTIC: StepShape = StepShape {
    velocity: 1.875,
    acceleration: 5.773_502_691_896_258,
    jerk: 60.0,
};
/// The step whose velocity is 3s² − 2s³, per unit of that velocity.
pub const SPEED_UP: StepShape = StepShape {
    velocity: 1.0,
    acceleration: 1.5,
    jerk: 6.0,
};

impl AxisLimits {
    /// The least time for a step by `distance`.
    pub fn time_for(&self, distance: f64, shape: StepShape) -> f64 {
        let distance = distance.abs();
        let by_velocity = shape.velocity * distance / self.velocity;
        let by_acceleration = (shape.acceleration * distance / self.acceleration).sqrt();
        let by_jerk = self.jerk.map_or(0.0, |jerk| {
            Scalar::powf(shape.jerk * distance / jerk, 1.0 / 3.0)
        });
        by_velocity.max(by_acceleration).max(by_jerk)
    }

    /// The least time for a change of the velocity by `change`.
    pub fn time_to_change(&self, change: f64, shape: StepShape) -> f64 {
        let change = change.abs();
        let by_jerk = self
            .jerk
            .map_or(0.0, |jerk| (shape.jerk * change / jerk).sqrt());
        (shape.acceleration * change / self.acceleration).max(by_jerk)
    }

    /// The parts of these limits that `motion` uses.
    fn share(&self, motion: &AxisMotion, cut: &AxisMotion, part: &AxisMotion) -> Share {
        let share = |limit: f64, most: fn(&AxisMotion) -> f64| {
            most(motion) / (limit + FOLLOWING * most(cut).max(most(part)))
        };
        let by_jerk = |jerk| share(jerk, |m| m.jerk.amount);
        Share([
            share(self.velocity, |m| m.velocity.amount),
            share(self.acceleration, |m| m.acceleration.amount),
            self.jerk.map_or(0.0, by_jerk),
        ])
    }
}

/// The parts that a lead uses of an axis' limits of velocity, acceleration and jerk.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share([f64; 3]);

impl Share {
    /// The largest.
    pub fn largest(self) -> f64 {
        self.0.into_iter().fold(0.0, f64::max)
    }

    /// The product of all parts beyond 1; 1 where none is.
    fn excess(self) -> f64 {
        self.0.map(|part| part.max(1.0)).iter().product()
    }

    /// The larger part of each limit.
    fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].max(other.0[k])))
    }
}

/// The parts that a lead uses of the limits of each axis. At 1 it just keeps a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Of C, which the spindle's change of speed decides.
    pub c: Share,
    /// Of X.
    pub x: Share,
    /// Of Z.
    pub z: Share,
}

impl Shares {
    /// The largest.
    pub fn largest(self) -> f64 {
        let [c, x, z] = [self.c, self.x, self.z].map(Share::largest);
        c.max(x).max(z)
    }

    /// The product of all parts beyond 1, over all axes; 1 where none is. Each limit counts by
    /// itself: a limit that cannot be kept must not hide another that can.
    pub fn excess(self) -> f64 {
        self.c.excess() * self.x.excess() * self.z.excess()
    }
}

/// How a lead moves.
#[derive(Debug, Clone, Copy)]
pub struct LeadMotion {
    /// The whole lead.
    pub whole: AxesMotion,
    /// The lead without its segments next to the join.
    pub away: AxesMotion,
}

impl LeadLimits {
    /// The parts that a lead uses of these limits. `cut` is how the cut moves, and `part` how the
    /// axes would move if they followed the part.
    pub fn shares(&self, motion: &LeadMotion, cut: &AxesMotion, part: &AxesMotion) -> Shares {
        let away = &motion.away;
        let machine = |axis| self.machine_share(axis, motion, cut, part);
        Shares {
            c: (self.c.share(&away.c, &cut.c, &part.c)).max(machine(Axis::C)),
            x: (self.x.share(&away.x, &cut.x, &part.x)).max(machine(Axis::X)),
            z: (self.z.share(&away.z, &cut.z, &part.z)).max(machine(Axis::Z)),
        }
    }

    /// The machine's limits hold for all of a lead where they hold for the cut that it joins. Where
    /// they do not, the lead may hardly exceed the cut.
    fn machine_share(
        &self,
        axis: Axis,
        motion: &LeadMotion,
        cut: &AxesMotion,
        part: &AxesMotion,
    ) -> Share {
        let most =
            |of: &AxesMotion, derivative| of.peak(axis, derivative).map_or(0.0, |peak| peak.amount);
        let share = |derivative: Derivative, limit: f64| {
            let value = KEPT * limit;
            if most(cut, derivative) <= value {
                return most(&motion.whole, derivative) / value;
            }
            let needed = most(cut, derivative).max(most(part, derivative));
            most(&motion.away, derivative) / (AT_THE_LIMIT * needed)
        };
        Share(Derivative::ALL.map(|derivative| {
            let limit = self.machine.limit(axis, derivative);
            limit.map_or(0.0, |limit| share(derivative, limit))
        }))
    }
}

/// Largest derivatives of a motion through positions `p` at times `t`, by differences.
pub fn motion_by_differences(t: &[f64], p: &[f64]) -> AxisMotion {
    let mut motion = AxisMotion::default();
    let (velocity, at) = divided(t, p);
    let (acceleration, at) = divided(&at, &velocity);
    let (jerk, _) = divided(&at, &acceleration);
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    motion.velocity.amount = largest(&velocity);
    motion.acceleration.amount = largest(&acceleration);
    motion.jerk.amount = largest(&jerk);
    motion
}

/// Slopes between neighbours, and the middles of the intervals, where they hold.
fn divided(t: &[f64], p: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pairs = t.windows(2).zip(p.windows(2));
    pairs
        .map(|(t, p)| ((p[1] - p[0]) / (t[1] - t[0]), 0.5 * (t[0] + t[1])))
        .unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_a_cubic_come_close_to_its_derivatives() {
        let t: Vec<f64> = (0..=1000).map(|k| 0.002 * f64::from(k)).collect();
        let p: Vec<f64> = t.iter().map(|t| t * t * t - t).collect();
        let motion = motion_by_differences(&t, &p);
        assert!((motion.velocity.amount - 11.0).abs() < 0.02);
        assert!((motion.acceleration.amount - 12.0).abs() < 0.02);
        assert!((motion.jerk.amount - 6.0).abs() < 1e-3);
    }

    #[test]
    fn a_step_takes_as_long_as_its_strictest_limit() {
        let axis = |velocity, acceleration, jerk| AxisLimits {
            velocity,
            acceleration,
            jerk,
        };
        let time = |axis: AxisLimits| axis.time_for(-2.0, QUINTIC);
        assert_eq!(time(axis(3.75, 1e9, None)), 1.0);
        assert!((time(axis(1e9, QUINTIC.acceleration * 2.0, None)) - 1.0).abs() < 1e-15);
        assert!((time(axis(1e9, 1e9, Some(15.0))) - 2.0).abs() < 1e-14);
        let speed_up = axis(1e9, 50.0, Some(6.0)).time_to_change(100.0, SPEED_UP);
        assert_eq!(speed_up, 10.0);
    }
}
