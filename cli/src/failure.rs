//! How a command fails: what the user sees, and the exit status.

use std::io::IsTerminal;

use turnpath_host::LoadError;
use turnpath_post::{FileError, ReadError};
use turnpath_recipe::{Diagnostic, Diagnostics, RecipeError};

/// Why a command did not do what it was asked. Each has the text as the user sees it.
#[derive(Debug)]
pub enum Failure {
    /// The recipe or the call is wrong.
    Wrong(String),
    /// A plugin failed.
    Plugin(String),
    /// A file could not be read or written.
    File(String),
}

impl Failure {
    /// The program's exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Wrong(_) => 2,
            Self::Plugin(_) => 3,
            Self::File(_) => 4,
        }
    }

    /// Tells the user.
    pub fn report(&self) {
        let (Self::Wrong(text) | Self::Plugin(text) | Self::File(text)) = self;
        eprintln!("{text}");
    }

    /// A plugin's failure that has a place in the recipe.
    pub fn plugin(diagnostic: &Diagnostic) -> Self {
        Self::Plugin(diagnostic.render(color()))
    }

    /// A recipe that is wrong in one or more ways.
    pub fn recipe(diagnostics: &[Diagnostic]) -> Self {
        let texts: Vec<String> = diagnostics.iter().map(|one| one.render(color())).collect();
        Self::Wrong(texts.join("\n\n"))
    }

    /// A wrong call, without a place in the recipe.
    pub fn call(message: impl std::fmt::Display) -> Self {
        Self::Wrong(format!("error: {message}"))
    }

    /// Standard output is gone, or something like it.
    pub fn output(error: &std::io::Error) -> Self {
        Self::File(format!("error: cannot write to standard output: {error}"))
    }
}

/// Whether messages are coloured: on a terminal, unless the user says otherwise.
fn color() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

impl From<RecipeError> for Failure {
    fn from(error: RecipeError) -> Self {
        let text = error.render(color());
        match error {
            RecipeError::File { .. } => Self::File(text),
            RecipeError::Wrong(_) => Self::Wrong(text),
        }
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Wrong(diagnostics.render(color()))
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Wrong(diagnostic.render(color()))
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        let text = format!("error: {error}");
        if error.is_io() {
            Self::File(text)
        } else {
            Self::Plugin(text)
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::File(format!("error: {error}"))
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::File(format!("error: {error}"))
    }
}
