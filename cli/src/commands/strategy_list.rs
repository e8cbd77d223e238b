//! The strategies as `turnpath list --format json` prints them, for scripts and editors.

use serde::Serialize;
use turnpath::declared::{default, kind_with_example, limits};
use turnpath::{Catalogue, LoadError, Strategy};
use turnpath_core::{ParamInfo, Slot};

/// The strategies of some slots.
#[derive(Debug, Serialize)]
pub struct StrategyList {
    format: u32,
    strategies: Vec<StrategyEntry>,
}

/// A strategy: what `turnpath explain` says of it.
#[derive(Debug, Serialize)]
struct StrategyEntry {
    slot: &'static str,
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    plugin: PluginEntry,
    params: Vec<ParamEntry>,
}

#[derive(Debug, Serialize)]
struct PluginEntry {
    name: String,
    version: String,
    file: Option<String>,
    sha256: Option<String>,
}

/// A parameter, in the words of a recipe.
#[derive(Debug, Serialize)]
struct ParamEntry {
    name: &'static str,
    help: &'static str,
    kind: String,
    default: String,
    limits: String,
}

impl StrategyList {
    /// The strategies of these slots, in the order of `turnpath list`.
    ///
    /// # Errors
    /// When the hash of a library cannot be calculated.
    pub fn new(catalogue: &Catalogue, slots: &[Slot]) -> Result<Self, LoadError> {
        catalogue.hash_all()?;
        let of_slot = |slot: &Slot| {
            let slot = *slot;
            let all = catalogue.strategies();
            all.filter(move |one| one.info().slot == slot).map(entry)
        };
        let strategies: Result<Vec<StrategyEntry>, LoadError> =
            slots.iter().flat_map(of_slot).collect();
        Ok(Self {
            format: 1,
            strategies: strategies?,
        })
    }
}

fn entry(strategy: &Strategy) -> Result<StrategyEntry, LoadError> {
    let (info, plugin) = (strategy.info(), strategy.plugin());
    Ok(StrategyEntry {
        slot: info.slot.key(),
        name: info.name,
        summary: info.summary,
        source: info.source,
        plugin: PluginEntry {
            name: plugin.name.clone(),
            version: plugin.version.clone(),
            file: plugin.file.as_ref().map(|file| file.display().to_string()),
            sha256: plugin.sha256()?.map(str::to_owned),
        },
        params: info.params.iter().map(param).collect(),
    })
}

fn param(info: &ParamInfo) -> ParamEntry {
    ParamEntry {
        name: info.name,
        help: info.help,
        kind: kind_with_example(info),
        default: default(info),
        limits: limits(info),
    }
}
