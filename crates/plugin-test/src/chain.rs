//! The strategies of a trial, made as a run makes them.

use std::fs;
use std::sync::Arc;

use turnpath_core::{DataFile, ParamValue, Params, Result as Answer, Slot, Task};
use turnpath_host::{Catalogue, Strategy};
use turnpath_pipeline::{Chain, Link, Preparation, prepare};
use turnpath_recipe::Recipe;

use crate::fault::FaultKind;

/// The stages of a recipe, and what they are prepared for.
pub struct TrialChain {
    /// The strategies.
    pub chain: Chain,
    /// Task, locus, first touch.
    pub preparation: Preparation,
}

impl TrialChain {
    /// Makes the strategies of a recipe, and prepares the part.
    pub fn new(recipe: &Recipe, catalogue: &Catalogue) -> Result<Self, FaultKind> {
        let chain = Chain {
            surface: link(recipe, catalogue, Slot::Surface, |one, params| {
                one.offer().surface(params)
            })?,
            feed: link(recipe, catalogue, Slot::Feed, |one, params| {
                one.offer().feed(params)
            })?,
            sampler: link(recipe, catalogue, Slot::Sampler, |one, params| {
                one.offer().sampler(params)
            })?,
            compensator: link(recipe, catalogue, Slot::Compensator, |one, params| {
                one.offer().compensator(params)
            })?,
            velocity: link(recipe, catalogue, Slot::Velocity, |one, params| {
                one.offer().velocity(params)
            })?,
            spindle: link(recipe, catalogue, Slot::Spindle, |one, params| {
                one.offer().spindle(params)
            })?,
        };
        let preparation =
            prepare(&chain.locus_links(), recipe.job_spec()).map_err(FaultKind::Path)?;
        Ok(Self { chain, preparation })
    }

    /// The task.
    pub fn task(&self) -> &Task {
        &self.preparation.task
    }
}

fn link<T: ?Sized>(
    recipe: &Recipe,
    catalogue: &Catalogue,
    slot: Slot,
    make: impl FnOnce(&Strategy, &Params) -> Answer<Arc<T>>,
) -> Result<Link<T>, FaultKind> {
    let choice = recipe.choice(slot);
    let Some(strategy) = catalogue.find(slot, choice.name()) else {
        let unknown = choice.unknown(&catalogue.names(slot));
        return Err(FaultKind::Parameters(unknown.into()));
    };
    let binding = choice
        .bind(&strategy.info())
        .map_err(FaultKind::Parameters)?;
    let mut params = binding.params;
    for file in binding.files {
        let path = file.path.value;
        let bytes = fs::read(recipe.resolve(&path));
        let bytes = bytes.map_err(|source| FaultKind::File {
            path: path.clone(),
            source,
        })?;
        let contents = DataFile {
            path,
            bytes: bytes.into(),
        };
        params.set(file.param, ParamValue::File(contents));
    }
    Ok(Link {
        slot,
        name: strategy.info().name.to_owned(),
        plugin: strategy.plugin().to_string(),
        strategy: make(strategy, &params).map_err(FaultKind::Construction)?,
    })
}
