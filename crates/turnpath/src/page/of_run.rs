//! The page of a run from its report and its sketch.

use turnpath_core::SurfaceModel;
use turnpath_host::Catalogue;
use turnpath_page::{FileAxes, RunPage, run_page};
use turnpath_recipe::Recipe;
use turnpath_report::{AxisNotes, PathSketch, RunReport};

use super::chain::choices;
use super::surface::surface_sketch;
use crate::axis_notes::{axis_notes, feed_direction};
use crate::diagnosis::of_measure;
use crate::error::Error;
use crate::folder::TOOLPATH;
use crate::posts::{layout, posts};

/// The page of a run; `surface` is what was wanted.
///
/// # Errors
/// When the surface fails.
pub fn page_of_run(
    (recipe, catalogue): (&Recipe, &Catalogue),
    surface: &dyn SurfaceModel,
    report: &RunReport,
    sketch: Option<PathSketch>,
) -> Result<String, Error> {
    let surface = surface_sketch(surface, &recipe.part);
    Ok(run_page(&RunPage {
        report: report.clone(),
        sketch,
        surface: surface.map_err(|error| of_measure(recipe, error))?,
        chain: choices(recipe, catalogue),
        axes: axes(recipe, report),
        recipe: Some(recipe.text().to_owned()),
    }))
}

/// What the axes of the table and of each program mean. The table has the places of the nose centre.
fn axes(recipe: &Recipe, report: &RunReport) -> Vec<FileAxes> {
    let table = FileAxes {
        file: TOOLPATH.to_owned(),
        notes: AxisNotes::new(feed_direction(recipe), false, false),
    };
    let programs = posts(recipe).zip(&report.programs);
    let programs = programs.map(|(post, program)| {
        // Which way C runs does not depend on the compensator.
        let c_sign = layout(recipe, post, true).format.c_sign();
        FileAxes {
            file: program.file.clone(),
            notes: axis_notes(recipe, c_sign < 0.0),
        }
    });
    std::iter::once(table).chain(programs).collect()
}
