//! The sheet of a drawing: what both forms of file are made from.

use crate::request::Size;
use crate::shape::Shape;

/// A figure on its sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    pub title: String,
    pub size: Size,
    pub shapes: Vec<Shape>,
}
