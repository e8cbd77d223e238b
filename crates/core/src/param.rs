//! Parameters of strategies: their declarations as data, and the values from a recipe.
//!
//! The host reads the declarations to check a recipe, to fill in defaults and to explain a
//! strategy. A strategy's constructor gets [`Params`], in which every declared parameter is present
//! and in range.

use std::collections::BTreeMap;

use crate::{Result, Slot};

/// The kind of quantity of a parameter. Inside turnpath a quantity is a number in mm, rad and s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamKind {
    /// A length, `"5 mm"`; inside in mm.
    Length,
    /// An angle, `"45 deg"`; inside in rad.
    Angle,
    /// A curvature or a spatial frequency, `"0.08 /mm"`; inside in 1/mm.
    PerLength,
    /// A feed per revolution, `"10 um/rev"`. A bare length is allowed too. Inside in mm.
    Feed,
    /// A pure number, `0.5`.
    Number,
    /// A whole number, `36`.
    Count,
    /// Yes or no, `true`.
    Flag,
    /// One of a few words.
    Choice(&'static [&'static str]),
    /// A list of rows of numbers. Each row has this many columns: `[[2, 0, 0.01], [0, 2, 0.02]]`.
    Rows(usize),
}

/// The value of a parameter, in inner units.
#[derive(Debug, Clone, PartialEq)]
pub enum ParamValue {
    /// A quantity, a number or a count.
    Number(f64),
    /// Yes or no.
    Flag(bool),
    /// A choice.
    Text(String),
    /// Rows of numbers, all with the declared number of columns.
    Rows(Vec<Vec<f64>>),
}

/// The value of a parameter that the recipe leaves out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamDefault {
    /// There is no default: the recipe must give the parameter.
    Required,
    /// There is no value: the strategy knows what to do without it.
    Absent,
    /// This number, in inner units.
    Number(f64),
    /// This flag.
    Flag(bool),
    /// This choice.
    Text(&'static str),
}

/// The declaration of one parameter.
///
/// ```
/// use turnpath_core::{Param, DEG};
/// const PARAMS: &[Param] = &[
///     Param::length("spacing", "largest arc between neighbouring points").positive(),
///     Param::angle("max_step", "largest angle step").default(45.0 * DEG).positive(),
/// ];
/// assert_eq!(PARAMS[0].name, "spacing");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Param {
    /// The key in the recipe.
    pub name: &'static str,
    /// One line of help.
    pub help: &'static str,
    /// The kind of quantity.
    pub kind: ParamKind,
    /// The value if the recipe leaves the parameter out.
    pub default: ParamDefault,
    /// Least value, in inner units.
    pub min: f64,
    /// Largest value, in inner units.
    pub max: f64,
    /// Whether `min` itself is excluded.
    pub above_min: bool,
    /// Whether zero is excluded.
    pub nonzero: bool,
}

impl Param {
    const fn new(name: &'static str, kind: ParamKind, help: &'static str) -> Self {
        Self {
            name,
            help,
            kind,
            default: ParamDefault::Required,
            min: f64::NEG_INFINITY,
            max: f64::INFINITY,
            above_min: false,
            nonzero: false,
        }
    }

    /// A length; inside in mm.
    pub const fn length(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Length, help)
    }

    /// An angle; inside in rad.
    pub const fn angle(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Angle, help)
    }

    /// A curvature or a spatial frequency; inside in 1/mm.
    pub const fn per_length(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::PerLength, help)
    }

    /// A feed per revolution; inside in mm.
    pub const fn feed(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Feed, help)
    }

    /// A pure number.
    pub const fn number(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Number, help)
    }

    /// A whole number, not negative.
    pub const fn count(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Count, help).min(0.0)
    }

    /// Yes or no.
    pub const fn flag(name: &'static str, help: &'static str) -> Self {
        Self::new(name, ParamKind::Flag, help)
    }

    /// One of a few words.
    pub const fn choice(
        name: &'static str,
        words: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        Self::new(name, ParamKind::Choice(words), help)
    }

    /// Rows of numbers, `columns` in each.
    pub const fn rows(name: &'static str, columns: usize, help: &'static str) -> Self {
        Self::new(name, ParamKind::Rows(columns), help)
    }

    /// Sets the default, in inner units.
    pub const fn default(mut self, value: f64) -> Self {
        self.default = ParamDefault::Number(value);
        self
    }

    /// Sets the default of a flag.
    pub const fn default_flag(mut self, value: bool) -> Self {
        self.default = ParamDefault::Flag(value);
        self
    }

    /// Sets the default of a choice.
    pub const fn default_choice(mut self, word: &'static str) -> Self {
        self.default = ParamDefault::Text(word);
        self
    }

    /// Allows a recipe to leave the parameter out. The strategy reads it with [`Params::given`].
    pub const fn optional(mut self) -> Self {
        self.default = ParamDefault::Absent;
        self
    }

    /// Sets the least value, in inner units.
    pub const fn min(mut self, least: f64) -> Self {
        self.min = least;
        self
    }

    /// Sets the largest value, in inner units.
    pub const fn max(mut self, largest: f64) -> Self {
        self.max = largest;
        self
    }

    /// Allows only values above zero.
    pub const fn positive(mut self) -> Self {
        self.min = 0.0;
        self.above_min = true;
        self
    }

    /// Excludes zero.
    pub const fn nonzero(mut self) -> Self {
        self.nonzero = true;
        self
    }

    /// Whether a number, in inner units, lies in the declared range.
    pub fn admits(&self, value: f64) -> bool {
        let above = if self.above_min {
            value > self.min
        } else {
            value >= self.min
        };
        value.is_finite() && above && value <= self.max && !(self.nonzero && value == 0.0)
    }
}

/// The values of a strategy's parameters by name, in inner units.
///
/// The getters panic on a name or a kind that the strategy did not declare. That is a mistake of
/// the strategy's author and shows at the first construction. The boundary turns the panic into an
/// error.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Params(BTreeMap<String, ParamValue>);

impl Params {
    /// A set without values.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets a value. The host and tests use it.
    pub fn set(&mut self, name: impl Into<String>, value: ParamValue) {
        self.0.insert(name.into(), value);
    }

    /// Sets a number, in inner units. Tests and examples use it.
    pub fn with(mut self, name: &str, value: f64) -> Self {
        self.set(name, ParamValue::Number(value));
        self
    }

    /// All values, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &ParamValue)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// The number of `name`, in inner units, if the recipe gives it or the parameter has a default.
    pub fn given(&self, name: &str) -> Option<f64> {
        match self.0.get(name) {
            Some(ParamValue::Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// A length in mm.
    pub fn length_mm(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// An angle in rad.
    pub fn angle_rad(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// A curvature or a spatial frequency in 1/mm.
    pub fn per_mm(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// A feed in mm per revolution.
    pub fn feed_mm(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// A pure number.
    pub fn number(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// A whole number as a float, ready for arithmetic.
    pub fn count(&self, name: &str) -> f64 {
        self.declared_number(name)
    }

    /// Yes or no.
    pub fn flag(&self, name: &str) -> bool {
        match self.0.get(name) {
            Some(ParamValue::Flag(value)) => *value,
            _ => undeclared(name, "flag"),
        }
    }

    /// One of the declared words.
    pub fn choice(&self, name: &str) -> &str {
        match self.0.get(name) {
            Some(ParamValue::Text(value)) => value,
            _ => undeclared(name, "choice"),
        }
    }

    /// Rows of numbers, each with the declared number of columns.
    pub fn rows(&self, name: &str) -> &[Vec<f64>] {
        match self.0.get(name) {
            Some(ParamValue::Rows(value)) => value,
            _ => undeclared(name, "list of rows"),
        }
    }

    fn declared_number(&self, name: &str) -> f64 {
        self.given(name)
            .unwrap_or_else(|| undeclared(name, "number"))
    }
}

fn undeclared(name: &str, kind: &str) -> ! {
    panic!("the strategy reads a {kind} `{name}`, but it declares none, or an optional one")
}

/// What every strategy declares about itself, and its constructor.
///
/// `Strategy` is not a supertrait of the slot's own trait ([`Surface`](crate::Surface),
/// [`FeedStrategy`](crate::FeedStrategy), [`Sampler`](crate::Sampler),
/// [`Compensator`](crate::Compensator), [`VelocitySolver`](crate::VelocitySolver)), so that the
/// slot's trait stays object-safe.
pub trait Strategy: Sized {
    /// The name in a recipe's `use = "…"`: lower case, with hyphens between words.
    const NAME: &'static str;
    /// One line that says what the strategy does.
    const SUMMARY: &'static str;
    /// The source of the method: a paper with the equation, or a standard; empty if there is none.
    const SOURCE: &'static str = "";
    /// The strategy's parameters.
    const PARAMS: &'static [Param] = &[];
    /// Builds the strategy from values that the host has checked against [`Self::PARAMS`].
    fn new(params: &Params) -> Result<Self>;
}

/// A strategy as `turnpath list` and `turnpath explain` show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrategyInfo {
    /// The slot that the strategy fills.
    pub slot: Slot,
    /// The strategy's name in a recipe.
    pub name: &'static str,
    /// One line that says what the strategy does.
    pub summary: &'static str,
    /// The paper and the equation, or empty.
    pub source: &'static str,
    /// The strategy's parameters.
    pub params: &'static [Param],
}
