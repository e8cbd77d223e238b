//! A drawing, whole.

use crate::png_file;
use crate::request::{Dots, DrawingError};
use crate::sheet::Sheet;
use crate::svg_file;

/// A figure on its page.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing(Sheet);

impl Drawing {
    pub(crate) fn of(sheet: Sheet) -> Self {
        Self(sheet)
    }

    /// As an SVG, whose sides are in mm.
    pub fn svg(&self) -> String {
        svg_file::svg(&self.0)
    }

    /// As a PNG on white, which says how large it is.
    ///
    /// # Errors
    /// When it has too many pixels.
    pub fn png(&self, dots: Dots) -> Result<Vec<u8>, DrawingError> {
        png_file::png(&self.0, dots)
    }
}
