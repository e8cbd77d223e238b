//! A new plugin: a crate with a small strategy that works, for an author to change.

mod name;
mod new_plugin_error;
mod source;
mod template;

use std::fs;
use std::path::{Path, PathBuf};

use turnpath_core::Slot;
use turnpath_files::FileError;
use turnpath_host::Catalogue;

use crate::error::Error;

pub use name::NameError;
pub use new_plugin_error::NewPluginError;
pub use source::{CrateSource, SourceError};

/// What a new plugin is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginRequest {
    /// The strategy's name, which is that of the crate too.
    pub name: String,
    /// The slot.
    pub slot: Slot,
    /// The folder in which the crate's own folder is made; it is made too if it is not there.
    pub folder: PathBuf,
    /// Where turnpath's crates come from.
    pub crates: CrateSource,
}

/// A crate that was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewPlugin {
    /// The crate's folder.
    pub folder: PathBuf,
    /// The files in it, relative to it.
    pub files: Vec<&'static str>,
}

/// Writes a crate with a strategy that works: source, manifest, a recipe that compares it, a page, and
/// what git ignores. `catalogue` has the names that are taken.
///
/// # Errors
/// When the name cannot be used, when the crate's folder is there already, when the crates are not
/// where they should come from, or when a file cannot be written. Of a crate that cannot be written
/// whole nothing is left.
pub fn new_plugin(request: &PluginRequest, catalogue: &Catalogue) -> Result<NewPlugin, Error> {
    let PluginRequest {
        name, slot, folder, ..
    } = request;
    name::check(name, *slot, catalogue).map_err(NewPluginError::from)?;
    let crates = request.crates.clone().whole();
    let crates = crates.map_err(NewPluginError::from)?;
    fs::create_dir_all(folder).map_err(|error| not_written(folder, error))?;
    let folder = match folder == Path::new(".") {
        true => PathBuf::from(name),
        false => folder.join(name),
    };
    match fs::create_dir(&folder) {
        Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            return Err(NewPluginError::FolderExists { folder }.into());
        }
        made => made.map_err(|error| not_written(&folder, error))?,
    }
    let mut files = vec![
        ("Cargo.toml", template::manifest(name, &crates)),
        ("src/lib.rs", template::source(*slot, name)),
        ("recipe.toml", template::recipe(*slot, name)),
        ("README.md", template::readme(*slot, name)),
        (".gitignore", "/target\n/out\n".to_owned()),
    ];
    // The versions that this program was built with: nothing needs to be fetched.
    let lock = crates.lock_file().map(fs::read_to_string);
    files.extend(lock.and_then(Result::ok).map(|text| ("Cargo.lock", text)));
    let written = write_all(&folder, &files);
    if written.is_err() {
        // The folder is this call's own; what cannot be removed is left.
        let _ = fs::remove_dir_all(&folder);
    }
    written?;
    Ok(NewPlugin {
        folder,
        files: files.into_iter().map(|(name, _)| name).collect(),
    })
}

fn write_all(folder: &Path, files: &[(&'static str, String)]) -> Result<(), Error> {
    let source = folder.join("src");
    fs::create_dir(&source).map_err(|error| not_written(&source, error))?;
    for (name, text) in files {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| not_written(&path, error))?;
    }
    Ok(())
}

fn not_written(path: &Path, error: std::io::Error) -> Error {
    let path = path.to_owned();
    FileError { path, error }.into()
}
