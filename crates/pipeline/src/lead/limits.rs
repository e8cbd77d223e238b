//! What a lead may ask of the axes.

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

/// How much more than following the part asks for a lead may ask for: X drifts on a little beyond
/// the cut, where slopes may be steeper.
const FOLLOWING: f64 = 1.25;
/// The same against a machine's own limit, which is no matter of gentleness, where the cut itself is
/// beyond it.
const AT_THE_LIMIT: f64 = 1.02;
/// A machine's limit holds up to this part of it; half of what a verdict allows.
const KEPT: f64 = 1.0005;

/// Limits of the three axes. What following the part asks of them beside the join, as the cut does
/// it, comes on top, and a quarter of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadLimits {
    /// C, rad and s.
    pub c: AxisLimits,
    /// X, mm and s.
    pub x: AxisLimits,
    /// Z, mm and s.
    pub z: AxisLimits,
    /// What the machine can do, which nothing comes on top of but what the cut itself asks for.
    pub machine: Machine,
}

impl Default for LeadLimits {
    /// Gentle for any machine of the kind: an air-bearing spindle comes to 500 rpm within 1.6 s,
    /// a slide moves at a tenth of what it can.
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
    /// Gentle ones, and within what a machine can do.
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
    /// By how much the path rests above the highest place of the part, mm.
    pub clearance: f64,
    /// What it may ask of the axes.
    pub limits: LeadLimits,
}

/// Largest values of the derivatives of a step from 0 to 1 within a time of 1.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

/// 10s³ − 15s⁴ + 6s⁵.
pub const QUINTIC: Shape = Shape {
    velocity: 1.875,
    acceleration: 5.773_502_691_896_258,
    jerk: 60.0,
};
/// The way of which 3s² − 2s³ is the velocity, per unit of that velocity.
pub const SPEED_UP: Shape = Shape {
    velocity: 1.0,
    acceleration: 1.5,
    jerk: 6.0,
};

impl AxisLimits {
    /// The least time for a step by `way`.
    pub fn time_for(&self, way: f64, shape: Shape) -> f64 {
        let way = way.abs();
        let by_velocity = shape.velocity * way / self.velocity;
        let by_acceleration = (shape.acceleration * way / self.acceleration).sqrt();
        let by_jerk = self
            .jerk
            .map_or(0.0, |jerk| Scalar::powf(shape.jerk * way / jerk, 1.0 / 3.0));
        by_velocity.max(by_acceleration).max(by_jerk)
    }

    /// The least time for a change of the velocity by `change`.
    pub fn time_to_change(&self, change: f64, shape: Shape) -> f64 {
        let change = change.abs();
        let by_jerk = self
            .jerk
            .map_or(0.0, |jerk| (shape.jerk * change / jerk).sqrt());
        (shape.acceleration * change / self.acceleration).max(by_jerk)
    }

    /// The parts that `motion` takes of what it may ask for.
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

/// The parts that a lead takes of what it may ask of an axis' velocity, acceleration and jerk.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share([f64; 3]);

impl Share {
    /// The largest.
    pub fn largest(self) -> f64 {
        self.0.into_iter().fold(0.0, f64::max)
    }

    /// By which factors they are beyond all that there is; 1 where none is.
    fn beyond(self) -> f64 {
        self.0.map(|part| part.max(1.0)).iter().product()
    }

    fn or_more(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].max(other.0[k])))
    }
}

/// The part that a lead takes of what it may ask of each axis: 1 where it just keeps its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Of C, which the spindle's speeding up decides.
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

    /// By which factors all axes together are beyond what they may; 1 where none is. Each limit
    /// counts by itself: one that cannot be kept must not hide another that can.
    pub fn beyond(self) -> f64 {
        self.c.beyond() * self.x.beyond() * self.z.beyond()
    }
}

/// How a lead moves.
#[derive(Debug, Clone, Copy)]
pub struct LeadMotion {
    /// All of it.
    pub whole: AxesMotion,
    /// Without what is next to the join.
    pub away: AxesMotion,
}

impl LeadLimits {
    /// What a lead takes of these limits and of what the cut or the part itself asks for.
    pub fn shares(&self, motion: &LeadMotion, cut: &AxesMotion, part: &AxesMotion) -> Shares {
        let away = &motion.away;
        let machine = |axis| self.machine_share(axis, motion, cut, part);
        Shares {
            c: (self.c.share(&away.c, &cut.c, &part.c)).or_more(machine(Axis::C)),
            x: (self.x.share(&away.x, &cut.x, &part.x)).or_more(machine(Axis::X)),
            z: (self.z.share(&away.z, &cut.z, &part.z)).or_more(machine(Axis::Z)),
        }
    }

    /// The machine's limits hold for all of a lead where they hold for the cut that it joins; where
    /// they do not, it asks for hardly more than that.
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

/// Largest derivatives of what goes through positions `p` at times `t`, by differences.
pub fn of_differences(t: &[f64], p: &[f64]) -> AxisMotion {
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

/// Slopes between neighbours, and the middles where they hold.
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
        let motion = of_differences(&t, &p);
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
