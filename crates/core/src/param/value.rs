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
    /// A file.
    File(DataFile),
}
