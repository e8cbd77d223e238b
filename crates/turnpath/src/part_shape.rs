//! The part's own shape, whether or not a tool fits it.

use turnpath_core::extreme::Extreme;
use turnpath_core::{Part, RadialRange, SurfaceModel, part_shape};
use turnpath_host::Catalogue;
use turnpath_pipeline::{Link, NamedSurface, PipelineError};
use turnpath_recipe::Recipe;
use turnpath_report as report;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::gap::of_preparation;
use crate::surface::surface;

/// What is known of the part of a recipe that `refusal` refuses.
///
/// # Errors
/// When the surface is not there or fails, or has no height somewhere on the part.
pub fn refused_check(
    recipe: &Recipe,
    catalogue: &Catalogue,
    refusal: &Error,
) -> Result<report::RefusedCheck, Error> {
    let surface = surface(recipe, catalogue, &DataFiles::default())?;
    let report = report::RefusedCheck {
        format: report::FORMAT,
        name: recipe.name.clone(),
        part: shape(recipe, &surface, &recipe.part)?,
        refused: refusal.to_string(),
    };
    Ok(report.rounded())
}

/// The extremes of the surface over the part.
pub fn shape(
    recipe: &Recipe,
    surface: &Link<dyn SurfaceModel>,
    part: &Part,
) -> Result<report::PartShape, Error> {
    let region = RadialRange {
        inner: part.inner_radius,
        outer: part.aperture_radius,
    };
    let found = part_shape::of(&NamedSurface::new(surface), region);
    let found =
        found.map_err(|error| of_preparation(recipe, surface, PipelineError::NoSurface(error)))?;
    let place = |extreme: &Extreme| {
        let at = extreme.position();
        report::PartPlace { x: at.x, y: at.y }
    };
    let height = |extreme: Extreme| report::PartHeight {
        height: extreme.value,
        at: place(&extreme),
    };
    let curvature = |extreme: Extreme, tip: bool| report::PartCurvature {
        curvature: extreme.value,
        tip,
        at: place(&extreme),
    };
    Ok(report::PartShape {
        lowest: height(found.lowest),
        highest: height(found.highest),
        steepest: report::PartSlope {
            angle: found.steepest.value,
            at: place(&found.steepest),
        },
        most_hollow: curvature(found.most_hollow, found.has_hollow_tip),
        most_domed: curvature(found.most_domed, found.has_domed_tip),
    })
}
