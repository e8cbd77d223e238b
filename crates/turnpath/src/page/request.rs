//! Which result gets its page, and why it may get none.

use std::path::PathBuf;

use crate::drawings::DrawingRequest;
use crate::summary::{ABLATION, PAGE, SUMMARY};

/// Which result gets its page.
#[derive(Debug, Clone, PartialEq)]
pub struct PageRequest {
    /// The folder of the result.
    pub folder: PathBuf,
    /// The recipe, where the summary does not have its text, or where data files lie beside it.
    pub recipe: Option<PathBuf>,
    /// Figures for papers besides; files without a folder of their own go to that of the result.
    pub drawings: Vec<DrawingRequest>,
}

impl PageRequest {
    /// Whether the folder has a file of this name.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.folder.join(name).exists()
    }
}

/// Why a result gets no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// The folder has neither a run nor an ablation.
    #[error("{} has no {SUMMARY} and no {ABLATION}", folder.display())]
    NoResult {
        /// The folder.
        folder: PathBuf,
    },
    /// The summary does not have the text of the recipe.
    #[error("{SUMMARY} does not have the text of its recipe")]
    NoRecipe,
    /// The run wrote no file of its path, so a page that is there has more than a new one would.
    #[error("{} has no file of its path, and a new page would lack what {PAGE} shows of it", folder.display())]
    NoPath {
        /// The folder.
        folder: PathBuf,
    },
    /// A data file of the recipe does not lie beside the result.
    #[error("{title}")]
    NoDataFile {
        /// Which file cannot be read, and why.
        title: String,
    },
    /// The text of a recipe is not the one that was run.
    #[error("{} is not the recipe of this result: its SHA-256 is another", recipe.display())]
    OtherRecipe {
        /// The recipe.
        recipe: PathBuf,
    },
}
