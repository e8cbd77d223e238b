//! The strategies that a recipe chooses: looked up, bound to their parameters, and made.

use std::sync::Arc;

use turnpath_core::{Compensator, Params, Slot, StrategyError, SurfaceModel, VelocitySolver};
use turnpath_host::{Catalogue, Strategy};
use turnpath_pipeline::{Chain, Link};
use turnpath_recipe::{Binding, Diagnostic, Diagnostics, Recipe};

use crate::data_files::DataFiles;
use crate::diagnosis::wrong_parameter;
use crate::error::Error;
use crate::named_files::{UsedFile, read_named, with_files};

/// The strategy that a recipe chooses, with its checked parameters. Its files are not read yet.
fn chosen<'a>(
    recipe: &Recipe,
    catalogue: &'a Catalogue,
    slot: Slot,
) -> Result<(&'a Strategy, Binding), Diagnostics> {
    let name = recipe.choice(slot).name();
    let Some(strategy) = catalogue.find(slot, name) else {
        return Err(recipe.unknown_strategy(slot, &catalogue.names(slot)).into());
    };
    let binding = recipe.bind(slot, &strategy.info())?;
    Ok((strategy, binding))
}

/// What is wrong with a recipe's choices as far as it is known before the strategies are made: all
/// of it.
pub fn wrong_choices(recipe: &Recipe, catalogue: &Catalogue) -> Vec<Diagnostic> {
    let wrong = |slot| chosen(recipe, catalogue, slot).err();
    let wrong = Slot::ALL.into_iter().filter_map(wrong);
    wrong
        .flat_map(|found| found.iter().cloned().collect::<Vec<_>>())
        .collect()
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
    for slot in Slot::ALL {
        let (_, binding) = chosen(recipe, catalogue, slot)?;
        used.extend(read_named(recipe, slot, &binding.files, files)?);
    }
    Ok(used)
}

fn link<T: ?Sized>(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
    slot: Slot,
    make: impl FnOnce(&Strategy, &Params) -> Result<Arc<T>, StrategyError>,
) -> Result<Link<T>, Error> {
    let (strategy, binding) = chosen(recipe, catalogue, slot)?;
    let params = with_files(recipe, slot, binding, files)?;
    let name = strategy.info().name.to_owned();
    let plugin = strategy.plugin().to_string();
    match make(strategy, &params) {
        Ok(strategy) => Ok(Link {
            slot,
            name,
            plugin,
            strategy,
        }),
        Err(error) => Err(not_made(recipe, slot, &name, &plugin, error)),
    }
}

/// A constructor that refuses its parameters means that the recipe is wrong; one that panics, that
/// the plugin is.
fn not_made(recipe: &Recipe, slot: Slot, name: &str, plugin: &str, error: StrategyError) -> Error {
    let (noun, span) = (slot.noun(), recipe.choice(slot).name.span.clone());
    match &error {
        StrategyError::Parameter {
            name: parameter,
            message,
        } => Error::refused_by(wrong_parameter(recipe, slot, parameter, message), error),
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

/// The recipe's surface alone.
pub fn surface(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<Link<dyn SurfaceModel>, Error> {
    link(
        recipe,
        catalogue,
        files,
        Slot::Surface,
        |strategy, params| strategy.offer().surface(params),
    )
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
        Slot::Compensator,
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
        Slot::Velocity,
        |strategy, params| strategy.offer().velocity(params),
    )
}

/// The recipe's strategies.
pub fn chain(recipe: &Recipe, catalogue: &Catalogue, files: &DataFiles) -> Result<Chain, Error> {
    Ok(Chain {
        surface: surface(recipe, catalogue, files)?,
        feed: link(recipe, catalogue, files, Slot::Feed, |strategy, params| {
            strategy.offer().feed(params)
        })?,
        sampler: link(
            recipe,
            catalogue,
            files,
            Slot::Sampler,
            |strategy, params| strategy.offer().sampler(params),
        )?,
        compensator: compensator(recipe, catalogue, files)?,
        velocity: velocity(recipe, catalogue, files)?,
        spindle: link(
            recipe,
            catalogue,
            files,
            Slot::Spindle,
            |strategy, params| strategy.offer().spindle(params),
        )?,
    })
}
