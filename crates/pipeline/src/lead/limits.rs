//! What a lead may ask of the axes.

use turnpath_core::Scalar;
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

/// How much more than the cut a lead may ask for where it follows the part: it does so a little
/// beyond where the cut begins or ends, and slopes may be steeper there.
const FOLLOWING: f64 = 1.25;

/// Limits of the three axes. What the cut itself asks of them beside the join comes on top, and a
/// quarter of it: a lead follows the part as the cut does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadLimits {
    /// C, rad and s.
    pub c: AxisLimits,
    /// X, mm and s.
    pub x: AxisLimits,
    /// Z, mm and s.
    pub z: AxisLimits,
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

    fn allow(&self, motion: &AxisMotion, cut: &AxisMotion) -> bool {
        let within = |asked: f64, limit: f64, cut: f64| asked <= limit + FOLLOWING * cut;
        within(motion.max_velocity, self.velocity, cut.max_velocity)
            && within(
                motion.max_acceleration,
                self.acceleration,
                cut.max_acceleration,
            )
            && self
                .jerk
                .is_none_or(|jerk| within(motion.max_jerk, jerk, cut.max_jerk))
    }
}

/// Which axes ask for more than they may.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beyond {
    /// C, which the spindle's speeding up decides.
    pub c: bool,
    /// X.
    pub x: bool,
    /// Z.
    pub z: bool,
}

impl Beyond {
    /// Whether any does.
    pub fn any(self) -> bool {
        self.c || self.x || self.z
    }
}

impl LeadLimits {
    /// What `motion` asks for beyond these limits and what the cut asks for.
    pub fn beyond(&self, motion: &AxesMotion, cut: &AxesMotion) -> Beyond {
        Beyond {
            c: !self.c.allow(&motion.c, &cut.c),
            x: !self.x.allow(&motion.x, &cut.x),
            z: !self.z.allow(&motion.z, &cut.z),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
