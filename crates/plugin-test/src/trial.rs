//! What an author says of a strategy: values of its parameters, and what it promises.

use std::path::PathBuf;

/// What an author promises of a strategy besides the contract, which holds for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Promise {
    /// A sampler: its nodes alone hold the interpolation tolerance as played, with exact rates and
    /// before refinement.
    Tolerance,
    /// A feed: the highest cusp is within the residual tolerance.
    Residual,
    /// A velocity solver: where the axes move by cubics, its velocities are theirs.
    ExactOnCubics,
}

/// One strategy as it is tried.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trial {
    /// The name, with its slot before it where two slots have one of that name.
    pub(crate) name: String,
    /// The lines of the strategy's table, and of further tables.
    pub(crate) lines: String,
    /// What the files that the lines name are relative to.
    pub(crate) folder: PathBuf,
    pub(crate) promises: Vec<Promise>,
}

impl Trial {
    /// A strategy with the defaults of its parameters. The name is `constant-arc`, or
    /// `sampler/constant-arc` where two slots of the crate have one of that name.
    pub fn of(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// The lines that a recipe would have in the strategy's table, such as `spacing = "0.5 mm"`.
    /// Further tables of the recipe may follow, and change the trial parts: `[part]`, `[tool]`,
    /// `[tolerance]`, `[machine]`, or another stage with its `use`.
    #[must_use]
    pub fn with(self, lines: impl Into<String>) -> Self {
        Self {
            lines: lines.into(),
            ..self
        }
    }

    /// The folder of the files that the lines name.
    #[must_use]
    pub fn with_files_in(self, folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            ..self
        }
    }

    /// Checks this promise too.
    #[must_use]
    pub fn promising(mut self, promise: Promise) -> Self {
        self.promises.push(promise);
        self
    }

    pub(crate) fn promises(&self, promise: Promise) -> bool {
        self.promises.contains(&promise)
    }
}
