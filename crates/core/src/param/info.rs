//! The declaration of a parameter as data.

use serde::{Deserialize, Deserializer, Serialize};
use turnpath_units::Quantity;

/// The kind of a parameter. Inside turnpath a quantity is a number in mm, rad and s.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ParamKind {
    /// A quantity with a unit: `"5 mm"`, `"45 deg"`, `"10 um/rev"`.
    Quantity(Quantity),
    /// A pure number, `0.5`.
    Number,
    /// A whole number, `36`.
    Count,
    /// Yes or no, `true`.
    Flag,
    /// One of a few words.
    Choice(#[serde(deserialize_with = "kept_words")] &'static [&'static str]),
    /// One of a few words, or a quantity: `"contact"`, `"0.5 mm"`.
    ChoiceOr(
        #[serde(deserialize_with = "kept_words")] &'static [&'static str],
        Quantity,
    ),
    /// Any text.
    Text,
    /// A list of texts: of these words, or any texts if there are none.
    List(#[serde(deserialize_with = "kept_words")] &'static [&'static str]),
    /// A list of rows of numbers. Each row has this many columns: `[[2, 0, 0.01], [0, 2, 0.02]]`.
    Rows(usize),
    /// A file, by its path relative to the recipe: `"measured.csv"`.
    File,
    /// A table of coefficients. Each has this many whole numbers as its key, and is a quantity, or a
    /// pure number without one: `{ 4 = "0.2 um", 11 = "-30 nm" }`, `{ "2,0" = "1 um" }`.
    Coefficients(usize, Option<Quantity>),
    /// A table of constants under names. Each is a number, an angle, or a power of a length:
    /// `{ k = "0.08 /mm", turns = 4 }`.
    Constants,
}

impl ParamKind {
    /// The quantity; `None` for a kind that carries no unit.
    pub const fn quantity(self) -> Option<Quantity> {
        match self {
            Self::Quantity(quantity) | Self::ChoiceOr(_, quantity) => Some(quantity),
            _ => None,
        }
    }
}

/// The value of a parameter that the recipe leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ParamDefault {
    /// There is no default: the recipe must give the parameter.
    Required,
    /// There is no value: the strategy knows what to do without it.
    Absent,
    /// This number, in inner units.
    Number(f64),
    /// This flag.
    Flag(bool),
    /// This choice or text.
    Text(&'static str),
    /// These texts.
    List(#[serde(deserialize_with = "kept_words")] &'static [&'static str]),
}

/// The declaration of one parameter, whatever its kind. [`Param::info`](crate::Param::info) makes
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ParamInfo {
    /// The key in the recipe.
    pub name: &'static str,
    /// One line of help.
    pub help: &'static str,
    /// The kind.
    pub kind: ParamKind,
    /// The value if the recipe leaves the parameter out.
    pub default: ParamDefault,
    /// Least value, in inner units.
    #[serde(default = "lowest", skip_serializing_if = "is_infinite")]
    pub min: f64,
    /// Largest value, in inner units.
    #[serde(default = "highest", skip_serializing_if = "is_infinite")]
    pub max: f64,
    /// Whether `min` itself is excluded.
    pub above_min: bool,
    /// Whether `max` itself is excluded.
    pub below_max: bool,
    /// Whether zero is excluded.
    pub nonzero: bool,
    /// A good value as a recipe has it, without quotes; empty for the usual one of the kind.
    pub example: &'static str,
}

impl ParamInfo {
    /// Whether a number, in inner units, lies in the declared range.
    pub fn admits(&self, value: f64) -> bool {
        let above = if self.above_min {
            value > self.min
        } else {
            value >= self.min
        };
        let below = if self.below_max {
            value < self.max
        } else {
            value <= self.max
        };
        value.is_finite() && above && below && !(self.nonzero && value == 0.0)
    }
}

// Texts cannot hold an infinite bound, so they leave it out.

fn is_infinite(bound: &f64) -> bool {
    bound.is_infinite()
}

fn lowest() -> f64 {
    f64::NEG_INFINITY
}

fn highest() -> f64 {
    f64::INFINITY
}

/// Reads the words of a declaration. Like every declaration, they stay for the whole program.
fn kept_words<'de, D: Deserializer<'de>>(words: D) -> Result<&'static [&'static str], D::Error> {
    let words = Vec::<String>::deserialize(words)?;
    let kept = words.into_iter().map(|word| &*word.leak());
    Ok(kept.collect::<Vec<_>>().leak())
}
