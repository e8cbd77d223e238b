//! The data files that a recipe names, with their contents.

use turnpath_core::{DataFile, ParamValue, Params};
use turnpath_recipe::{Binding, Choice, NamedFile, Recipe};

use crate::data_files::{Contents, DataFiles};
use crate::diagnosis::unreadable_file;
use crate::error::Error;

/// A data file, and the parameter that names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UsedFile {
    /// The path of the strategy's table, `surface` or `surface.1`.
    pub table: String,
    /// The parameter.
    pub param: &'static str,
    /// The path as the recipe gives it.
    pub path: String,
    /// What is in it.
    pub contents: Contents,
}

/// Reads the files that a recipe names for a strategy, unless they were read before.
///
/// # Errors
/// When one cannot be read.
pub fn read_named(
    recipe: &Recipe,
    choice: &Choice,
    named: &[NamedFile],
    files: &DataFiles,
) -> Result<Vec<UsedFile>, Error> {
    let read = |file: &NamedFile| {
        let NamedFile { param, path } = file;
        match files.read(&recipe.resolve(&path.value)) {
            Ok(contents) => Ok(UsedFile {
                table: choice.path.clone(),
                param,
                path: path.value.clone(),
                contents,
            }),
            Err(source) => {
                let diagnostic = Box::new(unreadable_file(recipe, choice, param, path, &source));
                Err(Error::DataFile { diagnostic, source })
            }
        }
    };
    named.iter().map(read).collect()
}

/// A strategy's parameters with the contents of its files.
///
/// # Errors
/// When a file cannot be read.
pub fn with_files(
    recipe: &Recipe,
    choice: &Choice,
    binding: Binding,
    files: &DataFiles,
) -> Result<Params, Error> {
    let mut params = binding.params;
    for used in read_named(recipe, choice, &binding.files, files)? {
        let file = DataFile {
            path: used.path,
            bytes: used.contents.bytes,
        };
        params.set(used.param, ParamValue::File(file));
    }
    Ok(params)
}
