//! The kinds of parameters as types: `Param<Length>` is the key to a length.
//!
//! | kinds | type of the value |
//! |---|---|
//! | every quantity with a unit, such as [`Length`] and [`Angle`] | `f64` in mm, rad, s |
//! | [`Number`] | `f64` |
//! | [`Count`] | `u64` |
//! | [`Flag`] | `bool` |
//! | [`Choice`] | `&str`, one of the declared words |
//! | [`ChoiceOr`] a quantity | [`WordOrNumber`] |
//! | [`Text`] | `&str` |
//! | [`List`] | `&[String]` |
//! | [`Rows`] | `&[Vec<f64>]`, each row with the declared number of columns |
//! | [`File`] | [`&DataFile`](DataFile) |
//! | [`Coefficients`] | `&[Vec<f64>]`, each row with its whole numbers and then the value |
//! | [`Constants`] | `&[NamedConstant]`, in the order of the recipe |
//! | `Option` of a kind | `Option` of that type; `None` if the recipe leaves the parameter out |

use std::marker::PhantomData;

use turnpath_units::Quantity;

use super::value::{DataFile, NamedConstant, ParamValue};

/// A kind of parameter.
pub trait Kind: 'static {
    /// The type of a parameter's value.
    type Value<'a>;

    /// The value; `None` if there is none, or one of another kind.
    #[doc(hidden)]
    fn read(value: Option<&ParamValue>) -> Option<Self::Value<'_>>;
}

/// A kind whose values are numbers, in inner units, or numbers beside words.
pub trait Scale: Kind {}

/// A kind whose values have a unit.
pub trait UnitKind: Scale {
    /// The quantity.
    const QUANTITY: Quantity;
}

fn number(value: Option<&ParamValue>) -> Option<f64> {
    match value {
        Some(ParamValue::Number(number)) => Some(*number),
        _ => None,
    }
}

macro_rules! quantities {
    ($($name:ident, $what:literal;)+) => { $(
        #[doc = $what]
        #[derive(Debug)]
        pub enum $name {}

        impl Kind for $name {
            type Value<'a> = f64;

            fn read(value: Option<&ParamValue>) -> Option<f64> {
                number(value)
            }
        }

        impl Scale for $name {}

        impl UnitKind for $name {
            const QUANTITY: Quantity = Quantity::$name;
        }
    )+ };
}

quantities! {
    Length, "A length, `\"5 mm\"`; inside in mm.";
    Angle, "An angle, `\"45 deg\"`; inside in rad.";
    PerLength, "A curvature or a spatial frequency, `\"0.08 /mm\"`; inside in 1/mm.";
    Feed, "A feed per revolution, `\"10 um/rev\"`. A bare length is allowed too. Inside in mm.";
    RotationSpeed, "A speed of rotation, `\"500 rpm\"`; inside in rad/s.";
    Frequency, "A frequency, `\"70 Hz\"`; inside as ω in rad/s. A speed of rotation is allowed too.";
    Time, "A time, `\"1 s\"`; inside in s.";
    Velocity, "A speed along a line, `\"50 mm/s\"`; inside in mm/s.";
    Acceleration, "An acceleration along a line, `\"500 mm/s^2\"`; inside in mm/s².";
    Jerk, "A jerk along a line, `\"200 m/s^3\"`; inside in mm/s³.";
    AngularAcceleration, "An acceleration of rotation, `\"100 rad/s^2\"`; inside in rad/s².";
    AngularJerk, "A jerk of rotation, `\"1000 rad/s^3\"`; inside in rad/s³.";
}

/// A pure number, `0.5`.
#[derive(Debug)]
pub enum Number {}

impl Kind for Number {
    type Value<'a> = f64;

    fn read(value: Option<&ParamValue>) -> Option<f64> {
        number(value)
    }
}

impl Scale for Number {}

/// A whole number, `36`. It is at most 2⁵³, so that it is exact as a `f64` too.
#[derive(Debug)]
pub enum Count {}

impl Kind for Count {
    type Value<'a> = u64;

    fn read(value: Option<&ParamValue>) -> Option<u64> {
        number(value).map(|count| count as u64)
    }
}

/// Yes or no, `true`.
#[derive(Debug)]
pub enum Flag {}

impl Kind for Flag {
    type Value<'a> = bool;

    fn read(value: Option<&ParamValue>) -> Option<bool> {
        match value {
            Some(ParamValue::Flag(flag)) => Some(*flag),
            _ => None,
        }
    }
}

/// One of a few words.
#[derive(Debug)]
pub enum Choice {}

impl Kind for Choice {
    type Value<'a> = &'a str;

    fn read(value: Option<&ParamValue>) -> Option<&str> {
        match value {
            Some(ParamValue::Text(word)) => Some(word),
            _ => None,
        }
    }
}

/// One of a few words, or a quantity: `"contact"`, `"0.5 mm"`.
#[derive(Debug)]
pub struct ChoiceOr<Q>(PhantomData<fn() -> Q>);

/// The value of a parameter that is [one of a few words or a quantity](ChoiceOr).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WordOrNumber<'a> {
    /// One of the declared words.
    Word(&'a str),
    /// A quantity, in inner units.
    Number(f64),
}

impl<Q: UnitKind> Kind for ChoiceOr<Q> {
    type Value<'a> = WordOrNumber<'a>;

    fn read(value: Option<&ParamValue>) -> Option<WordOrNumber<'_>> {
        match value {
            Some(ParamValue::Text(word)) => Some(WordOrNumber::Word(word)),
            other => number(other).map(WordOrNumber::Number),
        }
    }
}

impl<Q: UnitKind> Scale for ChoiceOr<Q> {}

/// Any text.
#[derive(Debug)]
pub enum Text {}

impl Kind for Text {
    type Value<'a> = &'a str;

    fn read(value: Option<&ParamValue>) -> Option<&str> {
        Choice::read(value)
    }
}

/// A list of texts, `["csv"]`.
#[derive(Debug)]
pub enum List {}

impl Kind for List {
    type Value<'a> = &'a [String];

    fn read(value: Option<&ParamValue>) -> Option<&[String]> {
        match value {
            Some(ParamValue::List(texts)) => Some(texts),
            _ => None,
        }
    }
}

/// A list of rows of numbers, `[[2, 0, 0.01], [0, 2, 0.02]]`.
#[derive(Debug)]
pub enum Rows {}

impl Kind for Rows {
    type Value<'a> = &'a [Vec<f64>];

    fn read(value: Option<&ParamValue>) -> Option<&[Vec<f64>]> {
        match value {
            Some(ParamValue::Rows(rows)) => Some(rows),
            _ => None,
        }
    }
}

/// A table of coefficients under whole numbers, `{ 4 = "0.2 um", 11 = "-30 nm" }`. Several whole
/// numbers have commas between them, `{ "2,0" = "1 um" }`. No two coefficients have the same ones.
#[derive(Debug)]
pub enum Coefficients {}

impl Kind for Coefficients {
    type Value<'a> = &'a [Vec<f64>];

    fn read(value: Option<&ParamValue>) -> Option<&[Vec<f64>]> {
        Rows::read(value)
    }
}

/// A table of constants under names, `{ k = "0.08 /mm", turns = 4 }`. Each is a number, an angle, or
/// a power of a length.
#[derive(Debug)]
pub enum Constants {}

impl Kind for Constants {
    type Value<'a> = &'a [NamedConstant];

    fn read(value: Option<&ParamValue>) -> Option<&[NamedConstant]> {
        match value {
            Some(ParamValue::Constants(constants)) => Some(constants),
            _ => None,
        }
    }
}

/// A file, by its path relative to the recipe: `"measured.csv"`.
#[derive(Debug)]
pub enum File {}

impl Kind for File {
    type Value<'a> = &'a DataFile;

    fn read(value: Option<&ParamValue>) -> Option<&DataFile> {
        match value {
            Some(ParamValue::File(file)) => Some(file),
            _ => None,
        }
    }
}

impl<K: Kind> Kind for Option<K> {
    type Value<'a> = Option<K::Value<'a>>;

    fn read(value: Option<&ParamValue>) -> Option<Option<K::Value<'_>>> {
        match value {
            None => Some(None),
            value => K::read(value).map(Some),
        }
    }
}
