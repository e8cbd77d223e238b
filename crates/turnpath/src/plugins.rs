//! Plugins that a recipe lists, and the plugins that a run used.

use std::sync::Arc;

use turnpath_core::Slot;
use turnpath_host::{Catalogue, LoadError, Plugin};
use turnpath_recipe::{Diagnostic, Recipe, Spanned};

use crate::error::Error;

/// The catalogue with the plugins that a recipe lists, which the caller trusts.
///
/// # Errors
/// When one of them cannot be loaded.
pub fn with_listed_plugins(mut catalogue: Catalogue, recipe: &Recipe) -> Result<Catalogue, Error> {
    for listed in &recipe.plugins {
        let path = recipe.resolve(&listed.value);
        let added = match path.is_dir() {
            true => catalogue.add_folder(&path),
            false => catalogue.add_file(&path),
        };
        added.map_err(|error| not_loaded(recipe, listed, error))?;
    }
    Ok(catalogue)
}

fn not_loaded(recipe: &Recipe, listed: &Spanned<String>, error: LoadError) -> Error {
    let path = recipe.resolve(&listed.value);
    // Nothing says whether a file or a folder was meant.
    let title = match error.is_missing() && !path.exists() {
        true => format!("there is no file or folder {}", path.display()),
        false => Diagnostic::from_error(&error).title().to_owned(),
    };
    let help = error.help().map(str::to_owned);
    let diagnostic = recipe.diagnostic(listed.span.clone(), title, "listed here", help);
    Error::ListedPlugin {
        diagnostic: Box::new(diagnostic),
        source: Box::new(error),
    }
}

/// The plugins of a recipe's strategies, each once.
pub fn used<'a>(recipe: &Recipe, catalogue: &'a Catalogue) -> Vec<&'a Arc<Plugin>> {
    let mut used: Vec<&Arc<Plugin>> = Vec::new();
    for choice in Slot::ALL.into_iter().flat_map(|slot| recipe.choices(slot)) {
        if let Some(strategy) = catalogue.find(choice.slot, choice.name()) {
            let plugin = strategy.plugin();
            if !used.iter().any(|other| Arc::ptr_eq(other, plugin)) {
                used.push(plugin);
            }
        }
    }
    used
}
