//! A surface of a lens design as a recipe.

mod recipe_text;
mod surface_tables;

use std::path::{Path, PathBuf};

use turnpath_files::read_bounded;
use turnpath_lens::{LensError, LensProblem, LensText, Selection, Side};
use turnpath_recipe::{Diagnostic, Diagnostics};

use crate::error::Error;
use crate::input_files::refuse_as_output;
use crate::recipe_file::write_recipe;
use recipe_text::recipe_text;

/// Largest lens file. One with a thousand surfaces of all parameters has 50 MiB.
const MOST_BYTES: u64 = 64 << 20;

/// Which surface of a design is made into a recipe, and how.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ImportRequest {
    /// The number of the surface; without it the only one that is bent.
    pub surface: Option<usize>,
    /// The side of the tool; without it the side without material.
    pub side: Option<Side>,
    /// The diameter of the part, mm; without it that of the aperture in the file.
    pub aperture: Option<f64>,
}

/// A recipe that was made of a design.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImportedRecipe {
    /// The file of the design.
    pub file: PathBuf,
    /// Its text.
    pub text: String,
    /// What stands in the design and may matter, a line each. The recipe has them as comments.
    pub notes: Vec<String>,
}

/// The problem of a lens file, with the file.
#[derive(Debug, thiserror::Error)]
#[error("{file}{}{problem}", if problem.line.is_some() { ", " } else { ": " })]
struct FileProblem {
    file: String,
    problem: LensProblem,
}

/// Makes a recipe of one surface of a lens file, a Zemax `.zmx`. The surface is exact; tool,
/// tolerances and strategies are those of a ready recipe, and their comments say that they are to be
/// set.
///
/// # Errors
/// When the file cannot be read, or when it does not say beyond doubt what the surface is.
pub fn import(file: &Path, request: &ImportRequest) -> Result<ImportedRecipe, Error> {
    let bytes = read_bounded(file, MOST_BYTES).map_err(|source| Error::Unreadable {
        path: file.to_owned(),
        source,
    })?;
    let selection = Selection {
        number: request.surface,
        side: request.side,
        radius: request.aperture.map(|diameter| 0.5 * diameter),
    };
    let read = LensText::new(&bytes).and_then(|text| text.surface(&selection));
    let surface = read.map_err(|error| refused(file, error))?;
    let notes = surface.notes.iter();
    Ok(ImportedRecipe {
        file: file.to_owned(),
        text: recipe_text(&surface, file),
        notes: notes
            .map(|note| format!("line {}: {}", note.line, note.text))
            .collect(),
    })
}

fn refused(file: &Path, error: LensError) -> Error {
    let diagnostic = |problem: &LensProblem| {
        Diagnostic::from_error(&FileProblem {
            file: file.display().to_string(),
            problem: problem.clone(),
        })
    };
    let diagnostics: Diagnostics = error.problems().iter().map(diagnostic).collect();
    Error::refused_by(diagnostics, error)
}

impl ImportedRecipe {
    /// Writes the recipe into a file.
    ///
    /// # Errors
    /// When the file is there and is not to be replaced, when it is the one that was imported, or when it cannot
    /// be written.
    pub fn write(&self, path: &Path, replace: bool) -> Result<(), Error> {
        refuse_as_output(path, [self.file.as_path()])?;
        write_recipe(&self.text, path, replace)
    }
}
