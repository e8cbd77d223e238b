//! The strategies of a recipe, one in each slot.

use turnpath_core::Slot;
use turnpath_host::Catalogue;
use turnpath_pipeline::Chain;
use turnpath_recipe::Recipe;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::strategies::{compensator, link, velocity};
use crate::surface::{MadeSurface, made_surface};

/// The recipe's strategies, and which of its surfaces, `surface dish`, may have other bytes on another
/// machine.
pub fn chain(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<(Chain, Vec<String>), Error> {
    let [feed, sampler, spindle] =
        [Slot::Feed, Slot::Sampler, Slot::Spindle].map(|slot| recipe.choice(slot));
    let MadeSurface {
        link: surface,
        inexact,
    } = made_surface(recipe, catalogue, files)?;
    let chain = Chain {
        surface,
        feed: link(recipe, catalogue, files, feed, |strategy, params| {
            strategy.offer().feed(params)
        })?,
        sampler: link(recipe, catalogue, files, sampler, |strategy, params| {
            strategy.offer().sampler(params)
        })?,
        compensator: compensator(recipe, catalogue, files)?,
        velocity: velocity(recipe, catalogue, files)?,
        spindle: link(recipe, catalogue, files, spindle, |strategy, params| {
            strategy.offer().spindle(params)
        })?,
    };
    Ok((chain, inexact))
}
