//! The values of parameters.

use std::sync::Arc;

/// A file that a recipe names. The host has read it once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataFile {
    /// The path as the recipe gives it, for messages.
    pub path: String,
    /// The contents.
    pub bytes: Arc<[u8]>,
}

/// The value of a parameter, in inner units.
#[derive(Debug, Clone, PartialEq)]
pub enum ParamValue {
    /// A quantity, a number or a count.
    Number(f64),
    /// Yes or no.
    Flag(bool),
    /// A choice, or another text.
    Text(String),
    /// Texts.
    List(Vec<String>),
    /// Rows of numbers, all with the declared number of columns.
    Rows(Vec<Vec<f64>>),
    /// A file.
    File(DataFile),
}
