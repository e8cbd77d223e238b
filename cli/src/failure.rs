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
        eprintln!("{}", self.text());
    }

    /// The text as the user sees it.
    pub fn text(&self) -> &str {
        let (Self::Wrong(text) | Self::Plugin(text) | Self::File(text)) = self;
        text
    }

    /// What is wrong in one line, without colours.
    pub fn title(&self) -> String {
        let plain = anstream::adapter::strip_str(self.text()).to_string();
        let line = plain.lines().next().unwrap_or_default();
        line.strip_prefix("error: ").unwrap_or(line).to_owned()
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

    /// A plugin that could not be loaded.
    pub fn load(error: &LoadError, details: bool) -> Self {
        Self::load_told(error, with_sources(error), details)
    }

    /// The same where the recipe lists the plugin.
    pub fn listed_load(error: &LoadError, diagnostic: &Diagnostic, details: bool) -> Self {
        Self::load_told(error, diagnostic.render(color()), details)
    }

    fn load_told(error: &LoadError, mut text: String, details: bool) -> Self {
        if let Some(comparison) = error.layout_details().filter(|_| details) {
            text = format!("{text}\n\n{comparison}");
        }
        match error {
            _ if error.is_io() => Self::File(text),
            _ if error.is_missing() => Self::Wrong(text),
            _ => Self::Plugin(text),
        }
    }

    /// Standard output is gone, or something like it.
    pub fn output(error: &std::io::Error) -> Self {
        Self::File(format!("error: cannot write to standard output: {error}"))
    }
}

/// An error with its sources, as the user sees it.
pub fn with_sources(error: &dyn std::error::Error) -> String {
    format!("error: {}", Diagnostic::from_error(error).title())
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

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::File(with_sources(&error))
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::File(with_sources(&error))
    }
}

#[cfg(test)]
mod tests {
    use turnpath_host::{BOUNDARY_VERSION, Refusal};

    use super::*;

    #[test]
    fn the_comparison_of_layouts_is_told_when_asked_for() {
        let error = LoadError::Refused {
            path: "libx.so".into(),
            refusal: Refusal::Layout {
                ours: BOUNDARY_VERSION,
                details: "field 3 is missing".to_owned(),
            },
        };
        let (short, long) = (Failure::load(&error, false), Failure::load(&error, true));
        assert_eq!(short.status(), 3);
        let (Failure::Plugin(short), Failure::Plugin(long)) = (short, long) else {
            panic!("a plugin's fault");
        };
        assert!(short.ends_with("against this program's turnpath-plugin"));
        assert_eq!(long, format!("{short}\n\nfield 3 is missing"));
    }

    #[test]
    fn what_is_missing_what_cannot_be_read_and_what_is_no_plugin_differ() {
        let path = std::path::PathBuf::from("labs");
        let missing = LoadError::NoFolder { path: path.clone() };
        let source = std::io::ErrorKind::PermissionDenied.into();
        let unreadable = LoadError::Unreadable { path, source };
        let not_a_plugin = LoadError::Refused {
            path: "libx.so".into(),
            refusal: Refusal::NotAPlugin,
        };
        let statuses = [missing, unreadable, not_a_plugin];
        let statuses = statuses.map(|error| Failure::load(&error, false).status());
        assert_eq!(statuses, [2, 4, 3]);
    }
}
