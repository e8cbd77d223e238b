//! The surface of a recipe on a grid, as CSV.

use std::io;
use std::path::Path;

use turnpath_core::{Gradients, Scalar, StrategyError, SurfaceModel};
use turnpath_files::{Draft, FileError};
use turnpath_host::Catalogue;
use turnpath_pipeline::{Link, PipelineError};
use turnpath_recipe::Recipe;

use crate::data_files::DataFiles;
use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::plots::check_grid;
use crate::surface::surface;

/// Writes the recipe's surface and its slopes at `count` × `count` points of the square around the
/// aperture, its edges included. A point beyond the part where the surface has no height is NaN.
///
/// # Errors
/// When `count` is not in [`GRID_POINTS`](crate::GRID_POINTS), when the surface is not there, has no
/// height at a point of the part, or fails, or when the file cannot be written.
pub fn write_sag(
    recipe: &Recipe,
    catalogue: &Catalogue,
    count: usize,
    file: &Path,
) -> Result<(), Error> {
    check_grid(count)?;
    let mut draft = Draft::begin(file)?;
    write_sag_to(recipe, catalogue, count, &mut draft, file)?;
    draft.complete()?;
    Ok(())
}

/// Writes the same into `output`; errors name it `name`.
///
/// # Errors
/// Those of [`write_sag`].
pub fn write_sag_to(
    recipe: &Recipe,
    catalogue: &Catalogue,
    count: usize,
    output: &mut impl io::Write,
    name: &Path,
) -> Result<(), Error> {
    check_grid(count)?;
    let surface = surface(recipe, catalogue, &DataFiles::default())?;
    let grid = Grid {
        half: recipe.part.aperture_radius,
        hole: recipe.part.inner_radius,
        count,
    };
    let mut rows = csv::Writer::from_writer(output);
    let not_written = |error: io::Error| FileError {
        path: name.to_owned(),
        error,
    };
    rows.write_record(["x_mm", "y_mm", "z_mm", "zx", "zy"])
        .map_err(|error| not_written(error.into()))?;
    for j in 0..grid.count {
        let row = grid.row(j, &surface);
        let row = row.map_err(|error| of_pipeline(recipe, error))?;
        for point in row {
            let written = rows.serialize(point);
            written.map_err(|error| not_written(error.into()))?;
        }
    }
    rows.flush().map_err(|error| not_written(error).into())
}

/// A square grid around the axis, its edges included.
struct Grid {
    half: f64,
    /// The radius of the part's hole, mm.
    hole: f64,
    count: usize,
}

impl Grid {
    fn at(&self, index: usize) -> f64 {
        let last = (self.count - 1) as f64;
        self.half * (2.0 * index as f64 - last) / last
    }

    /// x, y, z and both slopes along one row.
    fn row(
        &self,
        j: usize,
        surface: &Link<dyn SurfaceModel>,
    ) -> Result<Vec<[f64; 5]>, PipelineError> {
        let x: Vec<f64> = (0..self.count).map(|i| self.at(i)).collect();
        let y = vec![self.at(j); self.count];
        let mut z = vec![f64::NAN; self.count];
        let (mut zx, mut zy) = (z.clone(), z.clone());
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        let answer = surface.strategy.gradient(&x, &y, out);
        answer.map_err(|error| surface.failed("on the grid", error))?;
        let is_missing = |(place, z): (&f64, &f64)| {
            let radius = Scalar::hypot(*place, self.at(j));
            z.is_nan() && (self.hole..=self.half).contains(&radius)
        };
        if let Some(i) = x.iter().zip(&z).position(is_missing) {
            let what = format!(
                "the surface has no height at x = {:.4} mm, y = {:.4} mm",
                x[i], y[i]
            );
            return Err(PipelineError::NoSurface(StrategyError::failed(what)));
        }
        Ok((0..self.count)
            .map(|i| [x[i], y[i], z[i], zx[i], zy[i]])
            .collect())
    }
}
