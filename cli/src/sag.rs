//! `turnpath sag`: the surface on a grid.

use std::io;

use turnpath_core::{Gradients, StrategyError};
use turnpath_pipeline::Link;
use turnpath_post::{Draft, FileError};
use turnpath_recipe::Recipe;

use crate::args::SagArgs;
use crate::failure::Failure;
use crate::job::of_pipeline;
use crate::{Done, Verdict, strategies};

/// Writes the recipe's surface on a grid over the square around the aperture.
pub fn sag(args: &SagArgs) -> Done {
    let recipe = Recipe::load(&args.recipe.recipe, &args.recipe.set)?;
    let catalogue = strategies::catalogue_for(&recipe, &args.recipe)?;
    let surface = strategies::surface(&recipe, &catalogue)?;
    let grid = Grid {
        half: recipe.part.aperture_radius,
        count: args.grid as usize,
    };
    let mut rows = csv::Writer::from_writer(Draft::begin(&args.output)?);
    let failed = |error: io::Error| FileError {
        path: args.output.clone(),
        error,
    };
    rows.write_record(["x_mm", "y_mm", "z_mm", "zx", "zy"])
        .map_err(io::Error::other)
        .map_err(failed)?;
    for j in 0..grid.count {
        for row in grid
            .row(j, &surface)
            .map_err(|e| not_evaluated(&recipe, &surface, e))?
        {
            rows.serialize(row)
                .map_err(io::Error::other)
                .map_err(failed)?;
        }
    }
    let draft = rows
        .into_inner()
        .map_err(|error| failed(error.into_error()))?;
    draft.complete()?;
    Ok(Verdict::Holds)
}

fn not_evaluated(
    recipe: &Recipe,
    surface: &Link<dyn turnpath_core::SurfaceModel>,
    error: StrategyError,
) -> Failure {
    of_pipeline(recipe, surface.failed("on the grid", error))
}

/// A square grid around the axis, its edges included.
struct Grid {
    half: f64,
    count: usize,
}

impl Grid {
    fn at(&self, index: usize) -> f64 {
        let last = (self.count - 1) as f64;
        self.half * (2.0 * index as f64 - last) / last
    }

    /// x, y, z and both slopes along one row; NaN where the surface has no height.
    fn row(
        &self,
        j: usize,
        surface: &Link<dyn turnpath_core::SurfaceModel>,
    ) -> Result<Vec<[f64; 5]>, StrategyError> {
        let x: Vec<f64> = (0..self.count).map(|i| self.at(i)).collect();
        let y = vec![self.at(j); self.count];
        let mut z = vec![f64::NAN; self.count];
        let (mut zx, mut zy) = (z.clone(), z.clone());
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.strategy.gradient(&x, &y, out)?;
        Ok((0..self.count)
            .map(|i| [x[i], y[i], z[i], zx[i], zy[i]])
            .collect())
    }
}
