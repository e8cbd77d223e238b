//! Which figures are drawn, and why one may be refused.

use std::path::PathBuf;

use turnpath_drawing::{Dots, DrawingError, Figure, Size};

/// A figure for a paper.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawingRequest {
    /// What it shows.
    pub figure: Figure,
    /// Its file; the ending chooses the form, `.svg` or `.png`. Without a folder of its own it goes
    /// beside the others.
    pub file: PathBuf,
    /// Its size; the figure's own unless given.
    pub size: Option<Size>,
    /// Dots an inch of a PNG.
    pub dots: Dots,
}

/// Why figures cannot be drawn as they are asked for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingFileError {
    /// The file has an ending that stands for no form.
    #[error("the plot {}: a plot ends in .svg or .png", file.display())]
    Form {
        /// The file.
        file: PathBuf,
    },
    /// Two figures would be one file.
    #[error("two plots would be one file, {}", file.display())]
    SameFile {
        /// The file.
        file: PathBuf,
    },
    /// The result lists a file of this name, whose bytes are to stay.
    #[error("{} is a file of the result: choose another name for the plot", file.display())]
    InResult {
        /// The file.
        file: PathBuf,
    },
    /// Figures are files, and the outputs have no folder.
    #[error("plots need an output folder")]
    NoFolder,
    /// The result has nothing to draw.
    #[error("{} has no file of a path: there is nothing to plot", folder.display())]
    NoPath {
        /// The folder.
        folder: PathBuf,
    },
    /// A figure cannot have this size.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
}
