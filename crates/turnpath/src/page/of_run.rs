//! The page of a run from its report and its sketch.

use turnpath_core::SurfaceModel;
use turnpath_host::Catalogue;
use turnpath_page::{RunPage, run_page};
use turnpath_recipe::Recipe;
use turnpath_report::RunReport;
use turnpath_verify::PathSketch;

use super::chain::choices;
use super::sketch::path_sketch;
use super::surface::surface_sketch;
use crate::diagnosis::of_measure;
use crate::error::Error;

/// The page of a run; `surface` is what was wanted.
///
/// # Errors
/// When the surface fails.
pub fn page_of_run(
    (recipe, catalogue): (&Recipe, &Catalogue),
    surface: &dyn SurfaceModel,
    report: &RunReport,
    sketch: Option<&PathSketch>,
) -> Result<String, Error> {
    let surface = surface_sketch(surface, &recipe.part);
    Ok(run_page(&RunPage {
        report: report.clone(),
        sketch: sketch.map(path_sketch),
        surface: surface.map_err(|error| of_measure(recipe, error))?,
        chain: choices(recipe, catalogue),
        recipe: Some(recipe.text().to_owned()),
    }))
}
