//! The values of parameters.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// A file that a recipe names. The host has read it once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DataFile {
    /// The path as the recipe gives it, for messages.
    pub path: String,
    /// The contents. They are no text, so a text leaves them out.
    #[serde(skip)]
    pub bytes: Arc<[u8]>,
}

/// A constant that a recipe names: a number, an angle, or a power of a length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedConstant {
    /// The name: letters, digits and `_`, and no digit first.
    pub name: String,
    /// The value in powers of mm, and in rad.
    pub value: f64,
    /// The power of a length: 1 for a length, −1 for a quantity per length, 0 for numbers and
    /// angles.
    pub length_power: i32,
}

/// The value of a parameter, in inner units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ParamValue {
    /// A quantity, a number or a count.
    Number(f64),
    /// Yes or no.
    Flag(bool),
    /// A choice, or another text.
    Text(String),
    /// Texts.
    List(Vec<String>),
    /// Rows of numbers, all with the declared number of columns; or coefficients, each a row of its
    /// whole numbers and its value.
    Rows(Vec<Vec<f64>>),
    /// Named constants.
    Constants(Vec<NamedConstant>),
    /// A file.
    File(DataFile),
}
