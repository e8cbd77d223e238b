//! The surface of a recipe: one strategy, or several in their places, added up and posed.

use std::cell::Cell;
use std::sync::Arc;

use turnpath_core::{Placement, Slot, SurfaceModel};
use turnpath_host::Catalogue;
use turnpath_pipeline::{Link, NamedSurface, PlacedSurface, PoseError, PosedSurface, SurfaceSum};
use turnpath_recipe::{Diagnostics, Recipe, SurfaceEntry};

use crate::data_files::DataFiles;
use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::strategies::link;
use crate::surface_need::surface_need;

/// A recipe's surface, and which of those that it is made of may have other bytes on another machine.
pub struct MadeSurface {
    /// The surface.
    pub link: Link<dyn SurfaceModel>,
    /// Slot and name of each, `surface dish`.
    pub inexact: Vec<String>,
}

/// The recipe's surface. A single one that stays as it is is the strategy itself.
///
/// The path of a rough path is made for a surface that is lifted by what it leaves.
pub fn surface(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<Link<dyn SurfaceModel>, Error> {
    made_surface(recipe, catalogue, files).map(|made| made.link)
}

/// The same, with what it is made of.
pub fn made_surface(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
) -> Result<MadeSurface, Error> {
    let mut inexact = Vec::new();
    let mut links = Vec::new();
    for entry in &recipe.surfaces {
        let (link, byte_exact) = entry_surface(recipe, catalogue, files, entry)?;
        if !byte_exact {
            inexact.push(format!("{} {}", link.slot, link.name));
        }
        links.push(link);
    }
    let wanted = wanted_surface(recipe, links)?;
    let piston = recipe.allowance();
    if piston == 0.0 {
        return Ok(MadeSurface {
            link: wanted,
            inexact,
        });
    }
    let place = Placement {
        piston,
        ..Placement::PLAIN
    };
    let link: Link<dyn SurfaceModel> = Link {
        strategy: Arc::new(PlacedSurface::new(wanted.strategy.clone(), place)),
        ..wanted
    };
    Ok(MadeSurface { link, inexact })
}

/// One surface of a recipe, made for its part, and whether it has the same bytes on every machine.
fn entry_surface(
    recipe: &Recipe,
    catalogue: &Catalogue,
    files: &DataFiles,
    entry: &SurfaceEntry,
) -> Result<(Link<dyn SurfaceModel>, bool), Error> {
    let byte_exact = Cell::new(true);
    let need = surface_need(recipe, entry);
    let link = link(
        recipe,
        catalogue,
        files,
        &entry.choice,
        |strategy, params| {
            let (model, exact) = strategy.surface(params, need)?;
            byte_exact.set(exact);
            Ok(model)
        },
    )?;
    Ok((link, byte_exact.get()))
}

/// The surfaces of a recipe as one.
fn wanted_surface(
    recipe: &Recipe,
    links: Vec<Link<dyn SurfaceModel>>,
) -> Result<Link<dyn SurfaceModel>, Error> {
    match (links.as_slice(), recipe.surfaces.as_slice()) {
        ([_], [only]) if only.placement.is_plain() && recipe.pose.is_none() => {}
        _ => return composite(recipe, &links),
    }
    let only = links.into_iter().next();
    only.map_or_else(|| composite(recipe, &[]), Ok)
}

/// The surfaces in their places, added up and posed. Its errors carry the name of the surface that
/// failed.
fn composite(
    recipe: &Recipe,
    links: &[Link<dyn SurfaceModel>],
) -> Result<Link<dyn SurfaceModel>, Error> {
    let placed = links.iter().zip(&recipe.surfaces).enumerate().map(placed);
    let mut sum = Link {
        slot: Slot::Surface,
        name: recipe.surface_name(),
        plugin: plugins(links),
        strategy: added_up(placed.collect()),
    };
    let Some(pose) = recipe.pose else {
        return Ok(sum);
    };
    match PosedSurface::new(sum.strategy.clone(), pose) {
        Ok(posed) => sum.strategy = Arc::new(posed),
        Err(PoseError::Strategy(error)) => {
            let error = sum.failed("at the part's middle", error);
            return Err(of_pipeline(recipe, error));
        }
        Err(error) => return Err(no_pose(recipe, error)),
    }
    Ok(sum)
}

/// A surface of the sum, by its number.
type Numbered<'a> = (usize, (&'a Link<dyn SurfaceModel>, &'a SurfaceEntry));

fn placed((number, (link, entry)): Numbered<'_>) -> Arc<dyn SurfaceModel> {
    let named = Arc::new(NamedSurface::of_sum(link, number));
    match entry.placement.is_plain() {
        true => named,
        false => Arc::new(PlacedSurface::new(named, entry.placement)),
    }
}

fn added_up(mut surfaces: Vec<Arc<dyn SurfaceModel>>) -> Arc<dyn SurfaceModel> {
    match surfaces.len() {
        1 => surfaces.remove(0),
        _ => Arc::new(SurfaceSum::new(surfaces)),
    }
}

/// The plugins of a sum, each once.
fn plugins(links: &[Link<dyn SurfaceModel>]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for link in links {
        if !names.contains(&link.plugin.as_str()) {
            names.push(&link.plugin);
        }
    }
    names.join(" and ")
}

/// A surface without a pose: the recipe puts the part where the surface is not.
fn no_pose(recipe: &Recipe, error: PoseError) -> Error {
    let span = recipe.nearest_span("part.pose");
    let help = match error {
        PoseError::NoMiddle => "choose another `x` and `y`",
        PoseError::Overhang | PoseError::Strategy(_) => "choose smaller tilts",
    };
    let title = format!("the part cannot lie there: {error}");
    let diagnostic = recipe.diagnostic(span, title, "from this pose", [help.to_owned()]);
    Error::refused(Diagnostics::from(diagnostic))
}
