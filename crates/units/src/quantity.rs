//! The kinds of quantities that carry a unit, and the errors of reading them.

use serde::{Deserialize, Serialize};

/// The kinds of quantities that carry a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// A length; inside in mm.
    Length,
    /// An angle; inside in rad.
    Angle,
    /// A curvature or a spatial frequency; inside in 1/mm.
    PerLength,
    /// A feed per revolution; inside in mm. A bare length is allowed too.
    Feed,
    /// A speed of rotation; inside in rad/s.
    RotationSpeed,
    /// A frequency; inside as ω in rad/s. A speed of rotation is allowed too.
    Frequency,
    /// A time; inside in s.
    Time,
    /// A speed along a line; inside in mm/s.
    Velocity,
    /// An acceleration along a line; inside in mm/s².
    Acceleration,
    /// A jerk along a line; inside in mm/s³.
    Jerk,
    /// An acceleration of rotation; inside in rad/s².
    AngularAcceleration,
    /// A jerk of rotation; inside in rad/s³.
    AngularJerk,
}

/// Why a text is not a quantity of the expected kind.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum QuantityError {
    /// The text is a number without a unit.
    #[error("`{text}` has no unit, and {} needs one", wanted.noun())]
    NoUnit {
        /// The text in the recipe.
        text: String,
        /// The expected kind.
        wanted: Quantity,
    },
    /// The unit belongs to another kind of quantity.
    #[error("`{text}` is {}, where {} belongs", found.noun(), wanted.noun())]
    OtherKind {
        /// The text in the recipe.
        text: String,
        /// The kind that the unit belongs to.
        found: Quantity,
        /// The expected kind.
        wanted: Quantity,
    },
    /// The unit does not exist.
    #[error("`{unit}` is not a unit of {}", wanted.noun())]
    UnknownUnit {
        /// The unit in the recipe.
        unit: String,
        /// The expected kind.
        wanted: Quantity,
        /// A unit that the author may have meant.
        meant: Option<&'static str>,
    },
    /// There is no number before the unit.
    #[error("`{text}` does not begin with a number")]
    NotANumber {
        /// The text in the recipe.
        text: String,
    },
    /// The number is infinite, not a number, or too large for a double.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// The text in the recipe.
        text: String,
    },
}

impl Quantity {
    /// The kind in words, with an article: "a length".
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::PerLength => "a quantity per length",
            Self::Feed => "a feed per revolution",
            Self::RotationSpeed => "a speed of rotation",
            Self::Frequency => "a frequency",
            Self::Time => "a time",
            Self::Velocity => "a speed along a line",
            Self::Acceleration => "an acceleration along a line",
            Self::Jerk => "a jerk along a line",
            Self::AngularAcceleration => "an acceleration of rotation",
            Self::AngularJerk => "a jerk of rotation",
        }
    }

    /// A correct text, for messages.
    pub const fn example(self) -> &'static str {
        match self {
            Self::Length => "5 mm",
            Self::Angle => "45 deg",
            Self::PerLength => "0.08 /mm",
            Self::Feed => "10 um/rev",
            Self::RotationSpeed => "500 rpm",
            Self::Frequency => "70 Hz",
            Self::Time => "1 s",
            Self::Velocity => "50 mm/s",
            Self::Acceleration => "500 mm/s^2",
            Self::Jerk => "200 m/s^3",
            Self::AngularAcceleration => "100 rad/s^2",
            Self::AngularJerk => "1000 rad/s^3",
        }
    }
}
