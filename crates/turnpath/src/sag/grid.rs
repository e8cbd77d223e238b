//! The surface of a recipe on a grid of its own.

use std::io;
use std::path::Path;

use turnpath_core::{Gradients, Scalar, StrategyError, SurfaceModel};
use turnpath_files::Draft;
use turnpath_host::Catalogue;
use turnpath_pipeline::{Link, ON_DATA, PipelineError};
use turnpath_post::GridPoints;
use turnpath_recipe::Recipe;

use super::grid_file::{GridForm, GridWriter, not_written};
use crate::data_files::DataFiles;
use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::input_files::refuse_as_output;
use crate::plots::check_grid;
use crate::surface::surface;

/// What the points of a grid lack.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SagGaps {
    /// Points beyond the part at which the surface has no height.
    pub missing: usize,
    /// Points of the part that lie beyond the data that the surface was made from: the surface goes on there
    /// by itself.
    pub beyond_data: usize,
    /// The farthest of these from the data, mm.
    pub farthest: f64,
}

impl SagGaps {
    fn and(self, other: Self) -> Self {
        Self {
            missing: self.missing + other.missing,
            beyond_data: self.beyond_data + other.beyond_data,
            farthest: self.farthest.max(other.farthest),
        }
    }
}

/// Writes the recipe's surface at `count` × `count` points of the square around the aperture, its
/// edges included. The ending of the file's name chooses the form: `.gsf`, `.DAT` (Zemax), or CSV
/// with slopes for all others. A point beyond the part where the surface has no height is NaN, in
/// `.DAT` a hole. Gives what the points lack.
///
/// # Errors
/// When `count` is not in [`GRID_POINTS`](crate::GRID_POINTS), when the surface is not there, has no
/// height at a point of the part, or fails, when the file is one that is read here, or when it cannot
/// be written.
pub fn write_sag(
    recipe: &Recipe,
    catalogue: &Catalogue,
    count: usize,
    file: &Path,
) -> Result<SagGaps, Error> {
    check_grid(count)?;
    let form = GridForm::of(file);
    let files = DataFiles::default();
    let (surface, grid) = (
        surface(recipe, catalogue, &files)?,
        Grid::new(recipe, count),
    );
    let read = files.paths();
    let read = read.iter().map(|file| file.as_path());
    refuse_as_output(file, read.chain([recipe.path()]))?;
    if form == GridForm::Csv {
        let mut draft = Draft::begin(file)?;
        let gaps = write_rows(recipe, &grid, &surface, &mut draft, file)?;
        draft.complete()?;
        return Ok(gaps);
    }
    let title = format!("{}: surface", recipe.name);
    let Some(mut writer) = GridWriter::begin(form, file, &title, &grid.points())? else {
        return Ok(SagGaps::default());
    };
    let mut gaps = SagGaps::default();
    for j in (0..count).rev() {
        let row = grid.row(j, &surface);
        let (row, of_row) = row.map_err(|error| of_pipeline(recipe, error))?;
        gaps = gaps.and(of_row);
        writer.row(row.into_iter().map(|[_, _, z, _, _]| z))?;
    }
    writer.complete()?;
    Ok(gaps)
}

/// Writes the same as CSV into `output`; errors name it `name`.
///
/// # Errors
/// Those of [`write_sag`].
pub fn write_sag_to(
    recipe: &Recipe,
    catalogue: &Catalogue,
    count: usize,
    output: &mut impl io::Write,
    name: &Path,
) -> Result<SagGaps, Error> {
    check_grid(count)?;
    let surface = surface(recipe, catalogue, &DataFiles::default())?;
    write_rows(recipe, &Grid::new(recipe, count), &surface, output, name)
}

/// The lines of a grid, from the lowest row up.
fn write_rows(
    recipe: &Recipe,
    grid: &Grid,
    surface: &Link<dyn SurfaceModel>,
    output: &mut impl io::Write,
    name: &Path,
) -> Result<SagGaps, Error> {
    let mut rows = csv::Writer::from_writer(output);
    rows.write_record(["x_mm", "y_mm", "z_mm", "zx", "zy"])
        .map_err(|error| not_written(name, error))?;
    let mut gaps = SagGaps::default();
    for j in 0..grid.count {
        let row = grid.row(j, surface);
        let (row, of_row) = row.map_err(|error| of_pipeline(recipe, error))?;
        gaps = gaps.and(of_row);
        for point in row {
            let written = rows.serialize(point);
            written.map_err(|error| not_written(name, error))?;
        }
    }
    let flushed = rows.flush();
    flushed.map_err(|error| not_written(name, error))?;
    Ok(gaps)
}

/// A square grid around the axis, its edges included.
struct Grid {
    half: f64,
    /// The radius of the part's hole, mm.
    hole: f64,
    count: usize,
}

impl Grid {
    fn new(recipe: &Recipe, count: usize) -> Self {
        Self {
            half: recipe.part.aperture_radius,
            hole: recipe.part.inner_radius,
            count,
        }
    }

    fn points(&self) -> GridPoints {
        let pitch = 2.0 * self.half / (self.count - 1) as f64;
        GridPoints {
            columns: self.count,
            rows: self.count,
            pitch: [pitch; 2],
            middle: [0.0; 2],
        }
    }

    fn at(&self, index: usize) -> f64 {
        let last = (self.count - 1) as f64;
        self.half * (2.0 * index as f64 - last) / last
    }

    /// x, y, z and both slopes along one row, and what its points lack.
    fn row(
        &self,
        j: usize,
        surface: &Link<dyn SurfaceModel>,
    ) -> Result<(Vec<[f64; 5]>, SagGaps), PipelineError> {
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
        let is_of_part = |x: &f64| {
            let radius = Scalar::hypot(*x, self.at(j));
            (self.hole..=self.half).contains(&radius)
        };
        let is_missing = |(x, z): (&f64, &f64)| z.is_nan() && is_of_part(x);
        if let Some(i) = x.iter().zip(&z).position(is_missing) {
            let what = format!(
                "the surface has no height at x = {:.4} mm, y = {:.4} mm",
                x[i], y[i]
            );
            return Err(PipelineError::NoSurface(StrategyError::failed(what)));
        }
        let mut distances = vec![0.0; self.count];
        let answer = surface.strategy.beyond_data(&x, &y, &mut distances);
        answer.map_err(|error| surface.failed("for its data", error))?;
        let of_part = x.iter().zip(&distances).filter(|(x, _)| is_of_part(x));
        let beyond = of_part.filter(|(_, distance)| **distance > ON_DATA);
        let beyond: Vec<f64> = beyond.map(|(_, distance)| *distance).collect();
        let gaps = SagGaps {
            missing: z.iter().filter(|z| z.is_nan()).count(),
            beyond_data: beyond.len(),
            farthest: beyond.into_iter().fold(0.0, f64::max),
        };
        let row = (0..self.count).map(|i| [x[i], y[i], z[i], zx[i], zy[i]]);
        Ok((row.collect(), gaps))
    }
}
