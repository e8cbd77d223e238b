//! How a command fails: the text that the user sees, and the exit status.

use std::io::IsTerminal;

use turnpath::{Diagnostic, Error, Fault, FileError, LoadError, PluginsLockError, RecipeError};

use crate::args::RECIPE;
use crate::message::say;

/// Why a command did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The library says why.
    #[error(transparent)]
    Work(#[from] Error),
    /// The lock of plugins cannot be used.
    #[error(transparent)]
    Lock(#[from] PluginsLockError),
    /// The lock of plugins cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The call is wrong, apart from the recipe.
    #[error("{0}")]
    Call(String),
    /// No recipe is given, and the present folder has none of the usual name.
    #[error("no recipe is given, and this folder has no {RECIPE}")]
    NoRecipe,
    /// Standard output takes nothing.
    #[error("cannot write to standard output")]
    Output(#[source] std::io::Error),
}

impl Failure {
    /// The program's exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Call(_) | Self::NoRecipe | Self::Lock(PluginsLockError::Wrong { .. }) => 2,
            Self::Output(_) | Self::File(_) | Self::Lock(_) => 4,
            Self::Work(error) => match error.fault() {
                Fault::Request | Fault::Cancelled => 2,
                Fault::Plugin => 3,
                Fault::Files => 4,
            },
        }
    }

    /// Shows the failure to the user; `details` adds the comparison of a plugin's layout.
    pub fn report(&self, details: bool) {
        say(&self.text(details, color()));
    }

    fn text(&self, details: bool, color: bool) -> String {
        let mut texts = match self {
            Self::Work(error) => error
                .diagnostics()
                .iter()
                .map(|one| one.render(color))
                .collect(),
            _ => Vec::new(),
        };
        if texts.is_empty() {
            texts.push(self.without_place().render(color));
        }
        if details {
            texts.extend(self.layout_details().map(str::to_owned));
        }
        texts.join("\n\n")
    }

    /// The message of an error without a place in the recipe, its causes included.
    fn without_place(&self) -> Diagnostic {
        let help = match self {
            Self::Work(error) => error.help(),
            Self::NoRecipe => Some("give one, or write one with `turnpath init`"),
            _ => None,
        };
        Diagnostic::from_error(self).with_helps(help.map(str::to_owned))
    }

    fn layout_details(&self) -> Option<&str> {
        match self {
            Self::Work(Error::Load(error)) => error.layout_details(),
            Self::Work(Error::ListedPlugin { source, .. }) => source.layout_details(),
            _ => None,
        }
    }
}

/// Whether messages are coloured: on a terminal, unless the user says otherwise.
fn color() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Error::from(error).into()
    }
}

impl From<RecipeError> for Failure {
    fn from(error: RecipeError) -> Self {
        Error::from(error).into()
    }
}

#[cfg(test)]
mod tests {
    use turnpath_host::{BOUNDARY_VERSION, Refusal};

    use super::*;

    #[test]
    fn the_comparison_of_layouts_is_shown_when_asked_for() {
        let failure = Failure::from(LoadError::Refused {
            path: "libx.so".into(),
            refusal: Refusal::Layout {
                ours: BOUNDARY_VERSION,
                details: "field 3 is missing".to_owned(),
            },
        });
        assert_eq!(failure.status(), 3);
        let (short, long) = (failure.text(false, false), failure.text(true, false));
        assert!(short.ends_with("against this program's turnpath-plugin"));
        assert_eq!(long, format!("{short}\n\nfield 3 is missing"));
    }

    #[test]
    fn a_failure_of_files_names_its_cause() {
        let failure = Failure::from(LoadError::Unreadable {
            path: "labs".into(),
            source: std::io::ErrorKind::PermissionDenied.into(),
        });
        let text = failure.text(false, false);
        assert_eq!(failure.status(), 4);
        assert_eq!(text, "error: cannot read labs: permission denied");
    }
}
