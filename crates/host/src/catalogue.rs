//! All strategies that a run can choose from.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use turnpath_core::{HOST_KEYS, ParamKind, Slot, StrategyInfo, is_strategy_name};
use turnpath_plugin::Offer;

use crate::error::MOST_COLUMNS;
use crate::loader::{self, Library};
use crate::own_strategy::OwnTraits;
use crate::{
    Admission, HashError, LibraryFile, LoadError, OwnPlugin, Plugin, SourceHash, Strategy,
};

/// The strategies by slot and name, of linked and of loaded plugins.
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    strategies: BTreeMap<(Slot, &'static str), Strategy>,
    plugins: Vec<Arc<Plugin>>,
    admissions: Vec<Arc<dyn Admission>>,
    /// Folders that were added and had no library.
    empty_folders: Vec<PathBuf>,
}

impl Catalogue {
    /// A catalogue without strategies.
    pub fn new() -> Self {
        Self::default()
    }

    /// The strategies of the plugin crates that are linked into the program.
    ///
    /// # Errors
    /// When two linked crates have a strategy of one name, or when a strategy has a name that no
    /// recipe could choose or a parameter whose name belongs to the host.
    pub fn linked() -> Result<Self, LoadError> {
        let mut catalogue = Self::new();
        let mut by_crate: BTreeMap<&'static str, Vec<Offer>> = BTreeMap::new();
        for offer in turnpath_plugin::linked() {
            by_crate.entry(offer.crate_name()).or_default().push(offer);
        }
        for (crate_name, offers) in by_crate {
            let version = offers.first().map_or("", Offer::crate_version);
            let plugin = plugin(crate_name, version, None);
            catalogue.add(plugin, of_crate(offers))?;
        }
        Ok(catalogue)
    }

    /// The catalogue with the plugins of a folder, as [`add_folder`](Self::add_folder) adds them.
    ///
    /// ```no_run
    /// use turnpath_host::Catalogue;
    ///
    /// let catalogue = Catalogue::linked()?.with_folder("plugins")?;
    /// # Ok::<(), turnpath_host::LoadError>(())
    /// ```
    ///
    /// # Errors
    /// When a library of the folder cannot be loaded.
    pub fn with_folder(mut self, folder: impl AsRef<Path>) -> Result<Self, LoadError> {
        self.add_folder(folder)?;
        Ok(self)
    }

    /// The catalogue with the plugin of a file, as [`add_file`](Self::add_file) adds it.
    ///
    /// # Errors
    /// When the plugin cannot be loaded.
    pub fn with_file(mut self, file: impl AsRef<Path>) -> Result<Self, LoadError> {
        self.add_file(file)?;
        Ok(self)
    }

    /// The catalogue with strategies that the program makes itself.
    ///
    /// ```
    /// use turnpath_core::{NodeList, Path, Result, Revolutions, SamplerPlan, Slot};
    /// use turnpath_host::{Catalogue, OwnPlugin, OwnStrategy};
    ///
    /// #[derive(Clone)]
    /// struct Even(f64);
    ///
    /// impl SamplerPlan for Even {
    ///     fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
    ///         nodes.extend(block.turns().flat_map(|turn| turn.subdivide(self.0)));
    ///         Ok(())
    ///     }
    /// }
    ///
    /// let steps = 90.0;
    /// let even = OwnStrategy::sampler("even", move |_| Ok(Box::new(Even(steps))));
    /// let lab = OwnPlugin::new("lab", "0.1.0").with(even);
    /// let catalogue = Catalogue::linked()?.with_own(lab)?;
    /// assert!(catalogue.find(Slot::Sampler, "even").is_some());
    /// # Ok::<(), turnpath_host::LoadError>(())
    /// ```
    ///
    /// # Errors
    /// When one of them has a name that the catalogue has already or no recipe could choose, or a
    /// parameter whose name belongs to the host.
    pub fn with_own(mut self, own: OwnPlugin) -> Result<Self, LoadError> {
        self.add_own(own)?;
        Ok(self)
    }

    /// The catalogue, which asks this before it loads libraries from here on.
    pub fn with_admission(mut self, admission: Arc<dyn Admission>) -> Self {
        self.admissions.push(admission);
        self
    }

    /// Adds the plugins that lie directly in a folder, in the order of their names: the files
    /// `*.so`, `*.dylib` and `*.dll`. Other files and folders are ignored.
    ///
    /// # Errors
    /// When a library cannot be read or copied, is not admitted, or cannot be loaded. The libraries before
    /// one that cannot be loaded stay in the catalogue. The code of those behind it may have been loaded too.
    pub fn add_folder(&mut self, folder: impl AsRef<Path>) -> Result<(), LoadError> {
        let libraries = LibraryFile::read_folder(&folder)?;
        if libraries.is_empty() {
            self.empty_folders.push(folder.as_ref().to_owned());
        }
        self.add_libraries(libraries)
    }

    /// The folders that were added and had no library, in the order in which they were.
    pub fn empty_folders(&self) -> impl Iterator<Item = &Path> {
        self.empty_folders.iter().map(PathBuf::as_path)
    }

    /// Adds the plugin of a file. Nothing is added if the catalogue has the same library already, under
    /// whatever path. The file is read and copied even then.
    ///
    /// # Errors
    /// When the file cannot be read or copied, is not admitted, is not a plugin for this program, or has a
    /// strategy with a name that the catalogue has already or no recipe could choose, or with a
    /// parameter whose name belongs to the host. The catalogue then has nothing of the plugin.
    pub fn add_file(&mut self, file: impl AsRef<Path>) -> Result<(), LoadError> {
        self.add_libraries(vec![LibraryFile::read(file)?])
    }

    /// Adds strategies that the program makes itself, as [`with_own`](Self::with_own) does.
    ///
    /// # Errors
    /// Those of [`with_own`](Self::with_own). The catalogue then has nothing of the plugin.
    pub fn add_own(&mut self, own: OwnPlugin) -> Result<(), LoadError> {
        let (plugin, strategies) = own.into_parts();
        self.add(plugin, strategies)
    }

    fn add_libraries(&mut self, read: Vec<LibraryFile>) -> Result<(), LoadError> {
        let mut libraries = Vec::with_capacity(read.len());
        for library in read {
            if !self.has(&library)? {
                libraries.push(library);
            }
        }
        if libraries.is_empty() {
            return Ok(());
        }
        let admit = |admission: &Arc<dyn Admission>| admission.admit(&libraries);
        self.admissions.iter().try_for_each(admit)?;
        let libraries = without_repeats(libraries)?;
        let mut loaded = loader::load(&libraries).into_iter().zip(&libraries);
        let added = loaded.try_for_each(|(library, file)| self.add_library(library?, file));
        // Each removes its copy.
        libraries.into_par_iter().for_each(drop);
        added
    }

    /// Whether the same library is there already, under whatever path.
    fn has(&self, library: &LibraryFile) -> Result<bool, LoadError> {
        let known = self.plugins.iter().filter(|plugin| plugin.file.is_some());
        is_among(library, known.filter_map(|plugin| plugin.hash.as_ref()))
    }

    fn add_library(&mut self, library: Library, file: &LibraryFile) -> Result<(), LoadError> {
        let Library {
            crate_name,
            version,
            hash,
            offers,
        } = library;
        let from = Some((file.path().to_owned(), hash));
        self.add(plugin(&crate_name, &version, from), of_crate(offers))
    }

    fn add(
        &mut self,
        plugin: Plugin,
        strategies: Vec<(Offer, OwnTraits)>,
    ) -> Result<(), LoadError> {
        let plugin = Arc::new(plugin);
        let mut joined = self.strategies.clone();
        for (offer, own) in strategies {
            let info = offer.info();
            check(&info, &plugin)?;
            let strategy = Strategy::new(offer, Arc::clone(&plugin), own);
            if let Some(first) = joined.insert((info.slot, info.name), strategy) {
                return Err(LoadError::TwoOfOneName {
                    slot: info.slot,
                    name: info.name.to_owned(),
                    first: Arc::clone(first.plugin()),
                    second: plugin,
                });
            }
        }
        self.strategies = joined;
        self.plugins.push(plugin);
        Ok(())
    }

    /// All strategies, by slot and name.
    pub fn strategies(&self) -> impl Iterator<Item = &Strategy> {
        self.strategies.values()
    }

    /// The names of the strategies in a slot, sorted.
    pub fn names(&self, slot: Slot) -> Vec<&'static str> {
        self.strategies
            .keys()
            .filter(|(of, _)| *of == slot)
            .map(|(_, name)| *name)
            .collect()
    }

    /// The strategy of this name, if there is one.
    pub fn find(&self, slot: Slot, name: &str) -> Option<&Strategy> {
        // The map's keys hold static names, so `get` would take no name that lives shorter.
        self.strategies
            .iter()
            .find(|((of, known), _)| *of == slot && *known == name)
            .map(|(_, strategy)| strategy)
    }

    /// Calculates the hashes of all plugins, side by side. They are kept.
    ///
    /// # Errors
    /// When the copy of a library cannot be read.
    pub fn hash_all(&self) -> Result<(), HashError> {
        let plugins = self.plugins.par_iter();
        let hashed = plugins.map(|plugin| plugin.sha256().map(drop));
        // The first error in the order of the plugins, whatever the threads.
        let hashed: Vec<Result<(), HashError>> = hashed.collect();
        hashed.into_iter().collect()
    }

    /// The plugins in the order in which they were added.
    pub fn plugins(&self) -> &[Arc<Plugin>] {
        &self.plugins
    }
}

/// Each library once: a folder may hold one under several names.
fn without_repeats(libraries: Vec<LibraryFile>) -> Result<Vec<LibraryFile>, LoadError> {
    let mut different: Vec<LibraryFile> = Vec::with_capacity(libraries.len());
    for library in libraries {
        if !is_among(&library, different.iter().map(LibraryFile::hash))? {
            different.push(library);
        }
    }
    Ok(different)
}

/// Whether a library has the bytes of one of these hashes.
fn is_among<'a>(
    library: &LibraryFile,
    known: impl IntoIterator<Item = &'a SourceHash>,
) -> Result<bool, LoadError> {
    for known in known {
        if library.hash().is_of_same_bytes(known)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The offers of a crate, which has nothing of the program's own.
fn of_crate(offers: Vec<Offer>) -> Vec<(Offer, OwnTraits)> {
    let plain = offers.into_iter();
    plain.map(|offer| (offer, OwnTraits::default())).collect()
}

/// Refuses a name that no recipe could choose, parameters whose names belong to the host, and rows
/// that nobody could write.
fn check(info: &StrategyInfo, plugin: &Arc<Plugin>) -> Result<(), LoadError> {
    let (slot, name) = (info.slot, info.name.to_owned());
    let plugin = Arc::clone(plugin);
    if !is_strategy_name(info.name) {
        return Err(LoadError::UnusableName { slot, name, plugin });
    }
    for param in info.params {
        match param.kind {
            ParamKind::Rows(columns) | ParamKind::Coefficients(columns, _)
                if columns > MOST_COLUMNS =>
            {
                return Err(LoadError::TooManyColumns {
                    slot,
                    strategy: name,
                    param: param.name.to_owned(),
                    columns,
                    plugin,
                });
            }
            _ => {}
        }
    }
    let mut params = info.params.iter();
    match params.find(|param| HOST_KEYS.contains(&param.name)) {
        None => Ok(()),
        Some(param) => Err(LoadError::HostKey {
            slot,
            strategy: name,
            param: param.name.to_owned(),
            plugin,
        }),
    }
}

fn plugin(crate_name: &str, version: &str, from: Option<(PathBuf, SourceHash)>) -> Plugin {
    let (file, hash) = from.unzip();
    Plugin {
        name: crate_name.replace('_', "-"),
        version: version.to_owned(),
        file,
        hash,
        source: None,
        inexact: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::{Param, ParamInfo};

    use super::*;

    const WIDE: &[ParamInfo] = &[Param::rows("terms", usize::MAX, "of a polynomial").info()];
    const NARROW: &[ParamInfo] = &[Param::rows("terms", 3, "of a polynomial").info()];

    #[test]
    fn rows_that_nobody_could_write_are_refused() {
        let of = |params| {
            let info = StrategyInfo {
                slot: Slot::Surface,
                name: "wide",
                summary: "",
                source: "",
                params,
            };
            check(&info, &Arc::new(plugin("lab_wide", "1.0.0", None)))
        };
        assert!(of(NARROW).is_ok());
        let error = of(WIDE).unwrap_err().to_string();
        assert!(
            error.contains("`terms`") && error.contains("at most 1000"),
            "{error}"
        );
    }
}
