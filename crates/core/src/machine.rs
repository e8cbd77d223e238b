//! What a machine's axes can do: limits that a path is held against.

use crate::Quantity;

/// A machine's axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The radial slide.
    X,
    /// The slide that sets the depth.
    Z,
    /// The spindle.
    C,
}

/// A derivative of an axis' position in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The first.
    Velocity,
    /// The second.
    Acceleration,
    /// The third.
    Jerk,
}

impl Axis {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::X, Self::Z, Self::C];

    /// Its letter.
    pub const fn letter(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Z => "Z",
            Self::C => "C",
        }
    }
}

impl Derivative {
    /// All of them, from the first on.
    pub const ALL: [Self; 3] = [Self::Velocity, Self::Acceleration, Self::Jerk];

    /// Which derivative it is: it grows with this power of the speed at which a path is played.
    pub const fn order(self) -> u8 {
        match self {
            Self::Velocity => 1,
            Self::Acceleration => 2,
            Self::Jerk => 3,
        }
    }

    /// Its name: `velocity`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        }
    }

    /// The key of its limit in a recipe: `x_velocity`.
    pub fn key(self, axis: Axis) -> String {
        format!("{}_{}", axis.letter().to_ascii_lowercase(), self.name())
    }

    /// The quantity that it is on an axis.
    pub const fn quantity(self, axis: Axis) -> Quantity {
        match (axis, self) {
            (Axis::C, Self::Velocity) => Quantity::RotationSpeed,
            (Axis::C, Self::Acceleration) => Quantity::AngularAcceleration,
            (Axis::C, Self::Jerk) => Quantity::AngularJerk,
            (_, Self::Velocity) => Quantity::Velocity,
            (_, Self::Acceleration) => Quantity::Acceleration,
            (_, Self::Jerk) => Quantity::Jerk,
        }
    }
}

/// What one axis can do, as far as it is known; in mm or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisLimits {
    /// Largest speed.
    pub velocity: Option<f64>,
    /// Largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest jerk.
    pub jerk: Option<f64>,
}

/// What a machine can do, as far as it is known. The default knows no limit.
///
/// ```
/// use turnpath_core::{Axis, Derivative, Machine};
/// let mut machine = Machine::default();
/// assert!(!machine.has_limits());
/// *machine.limit_mut(Axis::X, Derivative::Acceleration) = Some(500.0);
/// assert_eq!(machine.x.acceleration, Some(500.0));
/// assert_eq!(machine.limits().count(), 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Machine {
    /// X, mm.
    pub x: AxisLimits,
    /// Z, mm.
    pub z: AxisLimits,
    /// C, rad.
    pub c: AxisLimits,
}

/// One limit of a machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Of which axis.
    pub axis: Axis,
    /// Of what.
    pub derivative: Derivative,
    /// The largest amount; mm or rad, and s.
    pub value: f64,
}

impl Limit {
    /// Its key in a recipe: `x_velocity`.
    pub fn key(&self) -> String {
        self.derivative.key(self.axis)
    }
}

impl Machine {
    /// A limit, if there is one.
    pub fn limit(&self, axis: Axis, derivative: Derivative) -> Option<f64> {
        let mut machine = *self;
        *machine.limit_mut(axis, derivative)
    }

    /// The place of a limit.
    pub fn limit_mut(&mut self, axis: Axis, derivative: Derivative) -> &mut Option<f64> {
        let limits = match axis {
            Axis::X => &mut self.x,
            Axis::Z => &mut self.z,
            Axis::C => &mut self.c,
        };
        match derivative {
            Derivative::Velocity => &mut limits.velocity,
            Derivative::Acceleration => &mut limits.acceleration,
            Derivative::Jerk => &mut limits.jerk,
        }
    }

    /// Every limit that is known, axis by axis.
    pub fn limits(&self) -> impl Iterator<Item = Limit> + '_ {
        let all = Axis::ALL
            .into_iter()
            .flat_map(|axis| Derivative::ALL.map(|derivative| (axis, derivative)));
        all.filter_map(|(axis, derivative)| {
            let value = self.limit(axis, derivative)?;
            Some(Limit {
                axis,
                derivative,
                value,
            })
        })
    }

    /// Whether any limit is known.
    pub fn has_limits(&self) -> bool {
        self.limits().next().is_some()
    }
}
