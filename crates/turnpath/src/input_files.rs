//! The files that a command reads, so that its output takes the place of none of them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::job::Job;

/// Refuses an output that would replace a file that the command reads, whatever path or link leads
/// to it. A second hard link keeps its contents where the first is replaced, so it is another file.
///
/// # Errors
/// When the output is one of the files.
pub fn refuse_as_output<'a>(
    output: &Path,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<(), Error> {
    // What is not there is none of them.
    let Ok(target) = fs::canonicalize(output) else {
        return Ok(());
    };
    let is_target = |input: &Path| fs::canonicalize(input).is_ok_and(|input| input == target);
    match inputs.into_iter().any(is_target) {
        true => Err(Error::OutputIsInput {
            path: output.to_owned(),
        }),
        false => Ok(()),
    }
}

impl Job {
    /// The recipe, and the data files that it names.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let named = self.data_files.iter();
        let named = named.map(|used| self.recipe.resolve(&used.path));
        named.chain([self.recipe.path().to_owned()]).collect()
    }
}
