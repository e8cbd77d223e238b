//! What a machine's axes can do: the limits for a path.

use serde::{Deserialize, Serialize};

use crate::Quantity;

/// An axis of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The radial slide.
    X,
    /// The slide that sets the depth.
    Z,
    /// The spindle.
    C,
}

/// A time derivative of an axis' position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The first derivative.
    Velocity,
    /// The second derivative.
    Acceleration,
    /// The third derivative.
    Jerk,
}

impl Axis {
    /// All axes.
    pub const ALL: [Self; 3] = [Self::X, Self::Z, Self::C];

    /// The axis' letter.
    pub const fn letter(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Z => "Z",
            Self::C => "C",
        }
    }
}

impl Derivative {
    /// All derivatives, from the first to the third.
    pub const ALL: [Self; 3] = [Self::Velocity, Self::Acceleration, Self::Jerk];

    /// The order of the derivative. The derivative grows with this power of the speed at which a
    /// path is played.
    pub const fn order(self) -> u8 {
        match self {
            Self::Velocity => 1,
            Self::Acceleration => 2,
            Self::Jerk => 3,
        }
    }

    /// The derivative's name, such as `velocity`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        }
    }

    /// The key of the derivative's limit in a recipe, such as `x_velocity`.
    pub fn key(self, axis: Axis) -> String {
        format!("{}_{}", axis.letter().to_ascii_lowercase(), self.name())
    }

    /// The quantity of the derivative on an axis.
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
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AxisLimits {
    /// Largest speed.
    pub velocity: Option<f64>,
    /// Largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest jerk.
    pub jerk: Option<f64>,
}

/// What a machine can do, as far as it is known. The default has no limits.
///
/// ```
/// use turnpath_core::{Axis, Derivative, Machine};
/// let mut machine = Machine::default();
/// assert!(!machine.has_limits());
/// *machine.limit_mut(Axis::X, Derivative::Acceleration) = Some(500.0);
/// assert_eq!(machine.x.acceleration, Some(500.0));
/// assert_eq!(machine.limits().count(), 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
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
    /// The axis that the limit applies to.
    pub axis: Axis,
    /// The derivative that the limit applies to.
    pub derivative: Derivative,
    /// The largest absolute value; in mm or rad, and s.
    pub value: f64,
}

impl Limit {
    /// The limit's key in a recipe, such as `x_velocity`.
    pub fn key(&self) -> String {
        self.derivative.key(self.axis)
    }
}

impl Machine {
    /// A limit, if it is known.
    pub fn limit(&self, axis: Axis, derivative: Derivative) -> Option<f64> {
        let mut machine = *self;
        *machine.limit_mut(axis, derivative)
    }

    /// A mutable reference to a limit.
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

    /// Every known limit, axis by axis.
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
