//! The strategies that a command can choose from, and their making.

use std::sync::Arc;

use turnpath_core::{Params, Slot, StrategyError, SurfaceModel};
use turnpath_host::{Catalogue, LoadError, Strategy};
use turnpath_pipeline::{Chain, Link};
use turnpath_recipe::{Diagnostic, Recipe};

use crate::args::{PluginArgs, RecipeArgs};
use crate::failure::Failure;

/// Folders to take plugins from, besides those on the command line.
const PLUGIN_PATH: &str = "TURNPATH_PLUGIN_PATH";

/// All strategies from the program itself, `--plugin-dir` and the environment.
pub fn catalogue(args: &PluginArgs) -> Result<Catalogue, Failure> {
    gathered(args).map_err(|error| Failure::load(&error, args.layout_details))
}

fn gathered(args: &PluginArgs) -> Result<Catalogue, LoadError> {
    let mut catalogue = Catalogue::linked()?;
    for folder in &args.plugin_dir {
        catalogue.add_folder(folder)?;
    }
    if let Some(folders) = std::env::var_os(PLUGIN_PATH) {
        for folder in std::env::split_paths(&folders).filter(|path| !path.as_os_str().is_empty()) {
            catalogue.add_folder(&folder)?;
        }
    }
    Ok(catalogue)
}

/// The same with the plugins that the recipe lists, if the user trusts it.
pub fn catalogue_for(recipe: &Recipe, args: &RecipeArgs) -> Result<Catalogue, Failure> {
    if let (Some(first), false) = (recipe.plugins.first(), args.trust_recipe) {
        let title = "the recipe asks to load plugins of its own, which takes --trust-recipe";
        let label = "native code that runs with your rights";
        let help = "look at what it lists; then call again with `--trust-recipe`, or leave \
                    `plugins` out and give folders that you trust with `--plugin-dir`";
        let help = [help.to_owned()];
        return Err(recipe
            .diagnostic(first.span.clone(), title, label, help)
            .into());
    }
    let mut catalogue = catalogue(&args.plugins)?;
    for listed in &recipe.plugins {
        let path = recipe.resolve(&listed.value);
        let added = match path.is_dir() {
            true => catalogue.add_folder(&path),
            false => catalogue.add_file(&path),
        };
        added.map_err(|error| {
            // Whether a file or a folder was meant is not to be seen.
            let title = match error.is_missing() && !path.exists() {
                true => format!("there is no file or folder {}", path.display()),
                false => Diagnostic::from_error(&error).title().to_owned(),
            };
            let place = listed.span.clone();
            let diagnostic = recipe.diagnostic(place, title, "listed here", []);
            Failure::listed_load(&error, &diagnostic, args.plugins.layout_details)
        })?;
    }
    Ok(catalogue)
}

/// The strategy that a recipe chose, with its checked parameters.
fn chosen<'a>(
    recipe: &Recipe,
    catalogue: &'a Catalogue,
    slot: Slot,
) -> Result<(&'a Strategy, Params), Failure> {
    let name = recipe.choice(slot).name();
    let Some(strategy) = catalogue.find(slot, name) else {
        return Err(recipe.unknown_strategy(slot, &catalogue.names(slot)).into());
    };
    let params = recipe.bind(slot, &strategy.info())?;
    Ok((strategy, params))
}

/// Whether the strategies that a recipe chooses are there, and take its parameters: all that is
/// wrong with them, as far as it is known before they are made.
pub fn complaints(recipe: &Recipe, catalogue: &Catalogue) -> Vec<Failure> {
    let wrong = |slot| chosen(recipe, catalogue, slot).err();
    Slot::ALL.into_iter().filter_map(wrong).collect()
}

fn link<T: ?Sized>(
    recipe: &Recipe,
    catalogue: &Catalogue,
    slot: Slot,
    make: impl FnOnce(&Strategy, &Params) -> Result<Arc<T>, StrategyError>,
) -> Result<Link<T>, Failure> {
    let (strategy, params) = chosen(recipe, catalogue, slot)?;
    let name = strategy.info().name.to_owned();
    let plugin = strategy.plugin().to_string();
    match make(strategy, &params) {
        Ok(made) => Ok(Link {
            slot,
            name,
            plugin,
            strategy: made,
        }),
        Err(error) => Err(not_made(recipe, slot, &name, &plugin, error)),
    }
}

/// A constructor that complains about its parameters means that the recipe is wrong; one that
/// panics, that the plugin is.
fn not_made(
    recipe: &Recipe,
    slot: Slot,
    name: &str,
    plugin: &str,
    error: StrategyError,
) -> Failure {
    let choice = recipe.choice(slot);
    match error {
        StrategyError::Parameter {
            name: parameter,
            message,
        } => wrong_parameter(recipe, slot, &parameter, &message),
        StrategyError::Failed(message) => {
            let title = format!("the {} `{name}` cannot be made: {message}", slot.noun());
            recipe
                .diagnostic(
                    choice.name.span.clone(),
                    title,
                    format!("from {plugin}"),
                    [],
                )
                .into()
        }
        panicked @ (StrategyError::Panicked(_) | StrategyError::Asked { .. }) => {
            let title = format!("the {} `{name}` of {plugin} {panicked}", slot.noun());
            let place = choice.name.span.clone();
            Failure::plugin(&recipe.diagnostic(place, title, "while it was made", []))
        }
    }
}

/// A parameter that a strategy cannot work with, underlined where it stands.
pub fn wrong_parameter(recipe: &Recipe, slot: Slot, parameter: &str, message: &str) -> Failure {
    let choice = recipe.choice(slot);
    let title = format!(
        "the {} `{}` cannot work with this: {message}",
        slot.noun(),
        choice.name()
    );
    let place = choice.param_span(parameter);
    recipe
        .diagnostic(place, title, format!("`{parameter}`"), [])
        .into()
}

/// The recipe's surface alone.
pub fn surface(recipe: &Recipe, catalogue: &Catalogue) -> Result<Link<dyn SurfaceModel>, Failure> {
    link(recipe, catalogue, Slot::Surface, |strategy, params| {
        strategy.offer().surface(params)
    })
}

/// The recipe's compensator alone.
pub fn compensator(
    recipe: &Recipe,
    catalogue: &Catalogue,
) -> Result<Link<dyn turnpath_core::Compensator>, Failure> {
    link(recipe, catalogue, Slot::Compensator, |strategy, params| {
        strategy.offer().compensator(params)
    })
}

/// The recipe's velocity solver alone.
pub fn velocity(
    recipe: &Recipe,
    catalogue: &Catalogue,
) -> Result<Link<dyn turnpath_core::VelocitySolver>, Failure> {
    link(recipe, catalogue, Slot::Velocity, |strategy, params| {
        strategy.offer().velocity(params)
    })
}

/// The recipe's five strategies.
pub fn chain(recipe: &Recipe, catalogue: &Catalogue) -> Result<Chain, Failure> {
    Ok(Chain {
        surface: surface(recipe, catalogue)?,
        feed: link(recipe, catalogue, Slot::Feed, |strategy, params| {
            strategy.offer().feed(params)
        })?,
        sampler: link(recipe, catalogue, Slot::Sampler, |strategy, params| {
            strategy.offer().sampler(params)
        })?,
        compensator: compensator(recipe, catalogue)?,
        velocity: velocity(recipe, catalogue)?,
    })
}
