//! The strategies that a recipe chooses: looked up, bound to their parameters, and made.

use std::path::Path;
use std::sync::Arc;

use turnpath_core::{Compensator, Params, Slot, StrategyError, VelocitySolver};
use turnpath_host::{Catalogue, Strategy};
use turnpath_pipeline::Link;
use turnpath_recipe::{Binding, Choice, Diagnostic, Diagnostics, Recipe, RecipeError};

use crate::data_files::DataFiles;
use crate::diagnosis::wrong_parameter;
use crate::error::Error;
use crate::named_files::{UsedFile, read_named, with_files};

/// The strategy that a recipe chooses, with its checked parameters. Its files are not read yet.
fn chosen<'a>(
    choice: &Choice,
    catalogue: &'a Catalogue,
) -> Result<(&'a Strategy, Binding), Diagnostics> {
    let Some(strategy) = catalogue.find(choice.slot, choice.name()) else {
        return Err(unknown(choice, catalogue).into());
    };
    let binding = choice.bind(&strategy.info())?;
    Ok((strategy, binding))
}

/// The message for a strategy that is not there. It says what the plugins hold that were loaded, since
/// the strategy may be one of a folder that was not given.
fn unknown(choice: &Choice, catalogue: &Catalogue) -> Diagnostic {
    let known = catalogue.names(choice.slot);
    let diagnostic = choice.unknown(&known);
    if known.is_empty() {
        return diagnostic;
    }
    let empty = catalogue.empty_folders();
    let diagnostic = empty.fold(diagnostic, |diagnostic, folder| {
        diagnostic.with_help(format!("{} has no plugin", folder.display()))
    });
    let loaded = catalogue.plugins().iter();
    let mut loaded = loaded.filter(|plugin| plugin.file.is_some()).peekable();
    if loaded.peek().is_none() && catalogue.empty_folders().next().is_none() {
        return diagnostic.with_help("a strategy of a plugin takes `--plugin-dir DIR`");
    }
    loaded.fold(diagnostic, |diagnostic, plugin| {
        let strategies = catalogue.strategies();
        let of_plugin = strategies.filter(|strategy| Arc::ptr_eq(strategy.plugin(), plugin));
        let names: Vec<String> = of_plugin
            .map(|strategy| format!("{} `{}`", strategy.info().slot, strategy.info().name))
            .collect();
        let file = plugin.file.as_deref().unwrap_or(Path::new(""));
        diagnostic.with_help(format!("{} has {}", file.display(), names.join(", ")))
    })
}

/// All choices of a recipe.
pub fn choices(recipe: &Recipe) -> impl Iterator<Item = &Choice> {
    Slot::ALL.into_iter().flat_map(|slot| recipe.choices(slot))
}

/// What is wrong with choices as far as it is known before the strategies are made: all of it.
pub fn wrong_choices<'a>(
    choices: impl IntoIterator<Item = &'a Choice>,
    catalogue: &Catalogue,
) -> Vec<Diagnostic> {
    let wrong = choices.into_iter();
    let wrong = wrong.filter_map(|choice| chosen(choice, catalogue).err());
    wrong
        .flat_map(|found| found.iter().cloned().collect::<Vec<_>>())
        .collect()
}

/// The error with what a catalogue knows to be wrong with the strategies, where a recipe could not be
/// read: so all that is wrong is said in one go. Any other error stays.
#[must_use]
pub fn with_wrong_strategies(error: Error, catalogue: &Catalogue) -> Error {
    match error {
        Error::Recipe(RecipeError::Wrong(wrong)) => {
            let more = wrong_choices(wrong.choices(), catalogue);
            RecipeError::Wrong(wrong.with_messages(more)).into()
        }
        other => other,
    }
}

/// The data files of a recipe's strategies.
///
/// # Errors
/// When a strategy is not there or does not take its parameters, or when a file cannot be read.
pub fn used_files(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<Vec<UsedFile>, Error> {
    let mut used = Vec::new();
    for choice in choices(recipe) {
        let (_, binding) = chosen(choice, catalogue)?;
        used.extend(read_named(recipe, choice, &binding.files, files)?);
    }
    Ok(used)
}

/// The strategy of a choice, made.
pub(crate) fn link<T: ?Sized>(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
    choice: &Choice,
    make: impl FnOnce(&Strategy, &Params) -> Result<Arc<T>, StrategyError>,
) -> Result<Link<T>, Error> {
    let (strategy, binding) = chosen(choice, catalogue)?;
    let params = with_files(recipe, choice, binding, files)?;
    let name = strategy.info().name.to_owned();
    let plugin = strategy.plugin().to_string();
    match make(strategy, &params) {
        Ok(strategy) => Ok(Link {
            slot: choice.slot,
            name,
            plugin,
            strategy,
        }),
        Err(error) => Err(not_made(recipe, choice, &plugin, error)),
    }
}

/// A constructor that refuses its parameters means that the recipe is wrong; one that panics, that
/// the plugin is.
fn not_made(recipe: &Recipe, choice: &Choice, plugin: &str, error: StrategyError) -> Error {
    let (noun, name) = (choice.slot.noun(), choice.name());
    let span = choice.name.span.clone();
    match &error {
        StrategyError::Parameter {
            name: parameter,
            message,
            place,
        } => {
            let diagnostic = wrong_parameter(recipe, choice, parameter, message, place.as_deref());
            Error::refused_by(diagnostic, error)
        }
        StrategyError::Failed(message) => {
            let title = format!("the {noun} `{name}` cannot be made: {message}");
            let label = format!("from {plugin}");
            Error::refused_by(recipe.diagnostic(span, title, label, []), error)
        }
        StrategyError::Panicked(_) | StrategyError::Delegate { .. } => {
            let title = format!("the {noun} `{name}` of {plugin} {error}");
            Error::strategy(
                recipe.diagnostic(span, title, "while it was made", []),
                error,
            )
        }
    }
}

/// The recipe's compensator alone.
pub fn compensator(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<Link<dyn Compensator>, Error> {
    link(
        recipe,
        catalogue,
        files,
        recipe.choice(Slot::Compensator),
        |strategy, params| strategy.offer().compensator(params),
    )
}

/// The recipe's velocity solver alone.
pub fn velocity(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<Link<dyn VelocitySolver>, Error> {
    link(
        recipe,
        catalogue,
        files,
        recipe.choice(Slot::Velocity),
        |strategy, params| strategy.offer().velocity(params),
    )
}
