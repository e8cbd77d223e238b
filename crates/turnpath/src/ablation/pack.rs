//! A folder with all that the runs of an ablation need: it travels with the plan.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use turnpath_files::FileError;
use turnpath_host::{Catalogue, Plugin, sha256_hex};
use turnpath_recipe::{Recipe, Span, Variant};
use turnpath_report::to_json;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::plugins;
use crate::plugins_lock::PluginsLock;
use crate::strategies::used_files;

use super::pack_error::PackError;
use super::plan::plan_of;
use super::{refuse_unknown, variants};

/// The folder of plugins in a packed folder.
pub const PLUGINS: &str = "plugins";
/// The lock of these plugins.
pub const LOCK: &str = "plugins.lock";
/// The plan of the runs.
pub const PLAN: &str = "plan.json";

/// A folder that was packed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedAblation {
    /// The recipe's copy.
    pub recipe: PathBuf,
    /// All files, the recipe among them.
    pub files: Vec<PathBuf>,
    /// Whether there are plugins among them.
    pub has_plugins: bool,
}

/// Writes a recipe's file, the data files and the plugins of its runs, a lock of these plugins and the
/// plan into a folder that is not there or empty. The keys of the runs are the same there.
///
/// # Errors
/// As those of [`plan_ablation`](super::plan_ablation); when the recipe was changed by `--set`; when a
/// file that it names is not below its folder; and when a file cannot be written. Of a folder that
/// cannot be written whole nothing is left.
pub fn pack_ablation(
    recipe: &Recipe,
    catalogue: &Catalogue,
    folder: &Path,
) -> Result<PackedAblation, Error> {
    if !recipe.sets().is_empty() {
        return Err(PackError::Changed.into());
    }
    let data = DataFiles::default();
    let (variants, keys) = variants(recipe, catalogue, &data)?;
    refuse_unknown(&keys)?;
    let mut contents = Contents::default();
    let name = recipe.path().file_name().map(PathBuf::from);
    let name = name.unwrap_or_else(|| PathBuf::from("recipe.toml"));
    contents.add(name.clone(), recipe.text().as_bytes().into())?;
    contents.add_data(recipe, &variants, catalogue, &data)?;
    let has_plugins = contents.add_plugins(recipe, &variants, catalogue)?;
    let plan = plan_of(&variants, &keys, folder);
    contents.add(PathBuf::from(PLAN), to_json(&plan).into_bytes().into())?;
    let files = contents.write(folder)?;
    Ok(PackedAblation {
        recipe: folder.join(name),
        files,
        has_plugins,
    })
}

/// The files of a folder, by their places in it.
#[derive(Default)]
struct Contents(BTreeMap<PathBuf, Arc<[u8]>>);

impl Contents {
    fn add(&mut self, place: PathBuf, bytes: Arc<[u8]>) -> Result<(), PackError> {
        match self.0.get(&place) {
            Some(other) if *other != bytes => Err(PackError::Twice { place }),
            Some(_) => Ok(()),
            None => {
                self.0.insert(place, bytes);
                Ok(())
            }
        }
    }

    fn add_data(
        &mut self,
        recipe: &Recipe,
        variants: &[Variant],
        catalogue: &Catalogue,
        data: &DataFiles,
    ) -> Result<(), Error> {
        for variant in variants {
            for file in used_files(&variant.recipe, catalogue, data)? {
                let span = || {
                    let key = format!("{}.{}", file.table, file.param);
                    variant.recipe.nearest_span(&key)
                };
                let place = place_of(recipe, &file.path, span)?;
                self.add(place, file.contents.bytes)?;
            }
        }
        Ok(())
    }

    /// Adds the libraries that the variants use: those that the recipe lists at their own places, the
    /// others to the folder of plugins, which gets a lock. Whether there are others.
    fn add_plugins(
        &mut self,
        recipe: &Recipe,
        variants: &[Variant],
        catalogue: &Catalogue,
    ) -> Result<bool, Error> {
        let mut has_others = false;
        for variant in variants {
            for plugin in plugins::used(&variant.recipe, catalogue) {
                let Some(file) = &plugin.file else { continue };
                let place = match listed_place(recipe, file)? {
                    Some(place) => place,
                    None => {
                        has_others = true;
                        Path::new(PLUGINS).join(file.file_name().unwrap_or_default())
                    }
                };
                self.add(place, library(plugin, file)?)?;
            }
        }
        if has_others {
            let lock = PluginsLock::text_of(catalogue)?;
            self.add(PathBuf::from(LOCK), lock.into_bytes().into())?;
        }
        Ok(has_others)
    }

    /// Writes all files into a new folder.
    fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        let not_written = |path: &Path, error| FileError {
            path: path.to_owned(),
            error,
        };
        let is_new = !folder.exists();
        fs::create_dir_all(folder).map_err(|error| not_written(folder, error))?;
        let mut entries = fs::read_dir(folder).map_err(|error| not_written(folder, error))?;
        if entries.next().is_some() {
            let folder = folder.to_owned();
            return Err(PackError::NotEmpty { folder }.into());
        }
        let write = |(place, bytes): (&PathBuf, &Arc<[u8]>)| {
            let path = folder.join(place);
            let parent = path.parent().unwrap_or(folder);
            let written = fs::create_dir_all(parent).and_then(|()| fs::write(&path, bytes));
            written.map_err(|error| not_written(&path, error))?;
            Ok(path)
        };
        let files: Result<Vec<PathBuf>, Error> = self.0.iter().map(write).collect();
        if files.is_err() {
            self.remove(folder, is_new);
        }
        files
    }

    /// Removes what was written; what cannot be removed is left.
    fn remove(&self, folder: &Path, is_new: bool) {
        for place in self.0.keys() {
            let _ = fs::remove_file(folder.join(place));
            let parents = place.ancestors().skip(1);
            for parent in parents.filter(|parent| *parent != Path::new("")) {
                // A folder that is not empty stays until its last file.
                let _ = fs::remove_dir(folder.join(parent));
            }
        }
        if is_new {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The bytes of a plugin, which are those that were loaded.
fn library(plugin: &Plugin, file: &Path) -> Result<Arc<[u8]>, Error> {
    let bytes = fs::read(file).map_err(|error| FileError {
        path: file.to_owned(),
        error,
    })?;
    match plugin.sha256()? == Some(&sha256_hex(&bytes)) {
        true => Ok(bytes.into()),
        false => Err(PackError::PluginChanged {
            path: file.to_owned(),
        }
        .into()),
    }
}

/// The place of a library that the recipe lists, or whose folder it lists; `None` where it does not.
fn listed_place(recipe: &Recipe, library: &Path) -> Result<Option<PathBuf>, Error> {
    for listed in &recipe.plugins {
        let named = canonical(&recipe.resolve(&listed.value));
        let is_folder = library.parent() == Some(&*named);
        if !is_folder && library != named {
            continue;
        }
        let place = place_of(recipe, &listed.value, || listed.span.clone())?;
        return Ok(Some(match is_folder {
            true => place.join(library.file_name().unwrap_or_default()),
            false => place,
        }));
    }
    Ok(None)
}

fn canonical(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Where a file that the recipe names lies relative to the recipe.
fn place_of(recipe: &Recipe, named: &str, span: impl Fn() -> Span) -> Result<PathBuf, Error> {
    let mut place = PathBuf::new();
    for component in Path::new(named).components() {
        match component {
            Component::Normal(name) => place.push(name),
            Component::CurDir => {}
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                let title = format!("`{named}` is not below the recipe's folder");
                let help = "a packed folder has the files at the places that the recipe names: move \
                            this one beside the recipe, and name it relative to it";
                let label = "this file cannot travel with the recipe";
                let wrong = recipe.diagnostic(span(), title, label, [help.to_owned()]);
                return Err(Error::refused(wrong));
            }
        }
    }
    Ok(place)
}
