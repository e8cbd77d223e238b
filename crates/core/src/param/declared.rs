//! The declaration of a parameter with its kind as a type.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::Range;

use turnpath_units::Quantity;

use super::info::{ParamDefault, ParamInfo, ParamKind};
use super::kind::{
    Acceleration, Angle, AngularAcceleration, AngularJerk, Choice, ChoiceOr, Coefficients,
    Constants, Count, Feed, File, Flag, Frequency, Jerk, Kind, Length, List, Number, PerLength,
    RotationSpeed, Rows, Scale, Text, Time, UnitKind, Velocity,
};
use crate::StrategyError;

/// The declaration of one parameter of the [kind](crate::kind) `K`, and the key to its value.
///
/// ```
/// use turnpath_core::kind::{Angle, Length};
/// use turnpath_core::{DEG, Param, ParamInfo};
///
/// const SPACING: Param<Length> =
///     Param::length("spacing", "largest arc between neighbouring points").positive();
/// const MAX_STEP: Param<Angle> =
///     Param::angle("max_step", "largest angle step").default(45.0 * DEG).positive();
/// const PARAMS: &[ParamInfo] = &[SPACING.info(), MAX_STEP.info()];
/// assert_eq!(PARAMS[0].name, "spacing");
/// ```
///
/// A kind cannot be mistaken for another:
///
/// ```compile_fail,E0308
/// # use turnpath_core::kind::{Angle, Length};
/// # use turnpath_core::Param;
/// const MAX_STEP: Param<Angle> = Param::length("max_step", "largest angle step");
/// ```
///
/// ```compile_fail,E0308
/// # use turnpath_core::kind::{Choice, Length};
/// # use turnpath_core::{Param, Params};
/// const SPACING: Param<Length> = Param::length("spacing", "largest arc");
/// fn word(params: &Params) -> &str {
///     params.get(SPACING)
/// }
/// ```
pub struct Param<K> {
    info: ParamInfo,
    kind: PhantomData<fn() -> K>,
}

impl<K> Clone for Param<K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K> Copy for Param<K> {}

impl<K> std::fmt::Debug for Param<K> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Param").field(&self.info).finish()
    }
}

impl<K> Param<K> {
    const fn new(name: &'static str, kind: ParamKind, help: &'static str) -> Self {
        Self::from_info(ParamInfo {
            name,
            help,
            kind,
            default: ParamDefault::Required,
            min: f64::NEG_INFINITY,
            max: f64::INFINITY,
            above_min: false,
            below_max: false,
            nonzero: false,
            example: "",
        })
    }

    const fn from_info(info: ParamInfo) -> Self {
        let kind = PhantomData;
        Self { info, kind }
    }

    /// The declaration as data, for [`Strategy::PARAMS`](crate::Strategy::PARAMS).
    pub const fn info(self) -> ParamInfo {
        self.info
    }

    /// The key in the recipe.
    pub const fn name(self) -> &'static str {
        self.info.name
    }

    /// Sets an example as a recipe has it, without quotes, for messages about a missing value.
    pub const fn example(mut self, text: &'static str) -> Self {
        self.info.example = text;
        self
    }

    /// The error that the strategy cannot work with this parameter's value. The host underlines the
    /// value in the recipe.
    pub fn refused(self, message: impl Into<Cow<'static, str>>) -> StrategyError {
        StrategyError::parameter(self.info.name, message)
    }

    /// The same for a text of which only the bytes at `place` are wrong.
    pub fn refused_at(
        self,
        place: Range<usize>,
        message: impl Into<Cow<'static, str>>,
    ) -> StrategyError {
        StrategyError::Parameter {
            name: self.info.name.into(),
            message: message.into(),
            place: Some(Box::new(place)),
        }
    }
}

impl<K: Kind> Param<K> {
    /// Allows a recipe to leave the parameter out. Its value is then `None`.
    pub const fn optional(self) -> Param<Option<K>> {
        let mut info = self.info;
        info.default = ParamDefault::Absent;
        Param::from_info(info)
    }
}

macro_rules! quantities {
    ($($constructor:ident, $kind:ident, $what:literal;)+) => { $(
        impl Param<$kind> {
            #[doc = $what]
            pub const fn $constructor(name: &'static str, help: &'static str) -> Self {
                const QUANTITY: Quantity = <$kind as UnitKind>::QUANTITY;
                Self::new(name, ParamKind::Quantity(QUANTITY), help)
            }
        }
    )+ };
}

quantities! {
    length, Length, "A length; inside in mm.";
    angle, Angle, "An angle; inside in rad.";
    per_length, PerLength, "A curvature or a spatial frequency; inside in 1/mm.";
    feed, Feed, "A feed per revolution; inside in mm.";
    rotation_speed, RotationSpeed, "A speed of rotation; inside in rad/s.";
    frequency, Frequency, "A frequency; inside as ω in rad/s.";
    time, Time, "A time; inside in s.";
    velocity, Velocity, "A speed along a line; inside in mm/s.";
    acceleration, Acceleration, "An acceleration along a line; inside in mm/s².";
    jerk, Jerk, "A jerk along a line; inside in mm/s³.";
    angular_acceleration, AngularAcceleration, "An acceleration of rotation; inside in rad/s².";
    angular_jerk, AngularJerk, "A jerk of rotation; inside in rad/s³.";
}

impl Param<Number> {
    /// A pure number.
    pub const fn number(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Number, help)
    }
}

impl<K: Scale> Param<K> {
    /// Sets the default, in inner units.
    pub const fn default(mut self, value: f64) -> Self {
        self.info.default = ParamDefault::Number(value);
        self
    }

    /// Sets the least value, in inner units.
    pub const fn min(mut self, least: f64) -> Self {
        self.info.min = least;
        self
    }

    /// Sets the largest value, in inner units.
    pub const fn max(mut self, largest: f64) -> Self {
        self.info.max = largest;
        self
    }

    /// Allows only values below this one, in inner units.
    pub const fn below(mut self, limit: f64) -> Self {
        self.info.max = limit;
        self.info.below_max = true;
        self
    }

    /// Allows only values above zero.
    pub const fn positive(mut self) -> Self {
        self.info.min = 0.0;
        self.info.above_min = true;
        self
    }

    /// Excludes zero.
    pub const fn nonzero(mut self) -> Self {
        self.info.nonzero = true;
        self
    }
}

impl Param<Count> {
    /// A whole number, not negative.
    pub const fn count(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Count, help).min(0)
    }

    /// Sets the default.
    pub const fn default(mut self, value: u64) -> Self {
        self.info.default = ParamDefault::Number(value as f64);
        self
    }

    /// Sets the least value.
    pub const fn min(mut self, least: u64) -> Self {
        self.info.min = least as f64;
        self
    }

    /// Sets the largest value.
    pub const fn max(mut self, largest: u64) -> Self {
        self.info.max = largest as f64;
        self
    }
}

impl Param<Flag> {
    /// Yes or no.
    pub const fn flag(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Flag, help)
    }

    /// Sets the default.
    pub const fn default(mut self, value: bool) -> Self {
        self.info.default = ParamDefault::Flag(value);
        self
    }
}

impl Param<Choice> {
    /// One of a few words.
    pub const fn choice(
        name: &'static str,
        words: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        Self::new(name, ParamKind::Choice(words), help)
    }

    /// Sets the default.
    pub const fn default(mut self, word: &'static str) -> Self {
        self.info.default = ParamDefault::Text(word);
        self
    }
}

impl Param<ChoiceOr<Length>> {
    /// One of a few words, or a length; inside in mm.
    pub const fn choice_or_length(
        name: &'static str,
        words: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        Self::new(name, ParamKind::ChoiceOr(words, Length::QUANTITY), help)
    }

    /// Sets the word that is the default.
    pub const fn default_word(mut self, word: &'static str) -> Self {
        self.info.default = ParamDefault::Text(word);
        self
    }
}

impl Param<Text> {
    /// Any text.
    pub const fn text(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Text, help)
    }

    /// Sets the default.
    pub const fn default(mut self, text: &'static str) -> Self {
        self.info.default = ParamDefault::Text(text);
        self
    }
}

impl Param<List> {
    /// A list of texts: of these words, or any texts if there are none.
    pub const fn list(
        name: &'static str,
        words: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        Self::new(name, ParamKind::List(words), help)
    }

    /// Sets the default.
    pub const fn default(mut self, words: &'static [&'static str]) -> Self {
        self.info.default = ParamDefault::List(words);
        self
    }
}

impl Param<Rows> {
    /// Rows of numbers, `columns` in each.
    pub const fn rows(name: &'static str, columns: usize, help: &'static str) -> Self {
        Self::new(name, ParamKind::Rows(columns), help)
    }
}

impl Param<Coefficients> {
    /// Coefficients that are pure numbers, each under `indices` whole numbers.
    pub const fn coefficients(name: &'static str, indices: usize, help: &'static str) -> Self {
        Self::new(name, ParamKind::Coefficients(indices, None), help)
    }

    /// Coefficients that are lengths, inside in mm, each under `indices` whole numbers.
    pub const fn length_coefficients(
        name: &'static str,
        indices: usize,
        help: &'static str,
    ) -> Self {
        let kind = ParamKind::Coefficients(indices, Some(Length::QUANTITY));
        Self::new(name, kind, help)
    }
}

impl Param<Constants> {
    /// Constants under names.
    pub const fn constants(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Constants, help)
    }
}

impl Param<File> {
    /// A file, by its path relative to the recipe.
    pub const fn file(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::File, help)
    }
}
