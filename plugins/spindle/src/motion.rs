//! The largest derivatives of X and Z in the C angle, for each cell of the path.

use turnpath_plugin::prelude::*;

use crate::grid::Grid;

/// Samples in a cell: 128 on a turn. What they miss of a peak, the played path shows to the host,
/// which asks again.
const SAMPLES: usize = 16;
/// Most samples of a path. On longer paths only some turns are sampled, evenly spread: two that
/// follow each other are a thousandth of the radius apart, or less.
const MOST_SAMPLES: usize = 400_000;
/// Samples in a batch.
const BATCH: usize = 4096;

/// What one cell asks of an axis: the largest |dp/dθ|, |d²p/dθ²| and |d³p/dθ³|, in mm.
pub type Derivatives = [f64; 3];

/// What one cell asks of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellMotion {
    /// X.
    pub x: Derivatives,
    /// Z.
    pub z: Derivatives,
    /// The largest distance of the nose centre from the spindle axis, mm.
    pub radius: f64,
}

impl CellMotion {
    /// Includes a sample. `reach` is the way to the middle between it and the next one, rad.
    fn include(&mut self, x: &Series, z: &Series, reach: f64) {
        const FACTORIALS: [f64; 3] = [1.0, 2.0, 6.0];
        for (k, factorial) in FACTORIALS.into_iter().enumerate() {
            self.x[k] = self.x[k].max(factorial * x[k + 1].abs());
            self.z[k] = self.z[k].max(factorial * z[k + 1].abs());
        }
        self.radius = self.radius.max(x[0].abs() + x[1].abs() * reach);
    }

    /// The larger of both, each amount by itself.
    fn and(&self, other: &Self) -> Self {
        let larger = |a: Derivatives, b: Derivatives| std::array::from_fn(|k| a[k].max(b[k]));
        Self {
            x: larger(self.x, other.x),
            z: larger(self.z, other.z),
            radius: self.radius.max(other.radius),
        }
    }
}

/// Looks at the whole path: the motion of every cell.
///
/// # Errors
/// If the tool centre has no derivatives somewhere.
pub fn motion(path: &Path<'_>, grid: &Grid) -> Result<Vec<CellMotion>> {
    let turn = grid.cells_in(1.0);
    let stride = (grid.cells * SAMPLES).div_ceil(MOST_SAMPLES);
    if stride <= 1 {
        return sample(path, grid, &(0..grid.cells).collect::<Vec<_>>());
    }
    let turns = grid.cells.div_ceil(turn);
    let mut sampled: Vec<usize> = (0..turns).step_by(stride).collect();
    if sampled.last() != Some(&(turns - 1)) {
        sampled.push(turns - 1);
    }
    // The last turn may be a part of one: its cells are counted back from the end.
    let last = grid.cells.saturating_sub(turn);
    let first_of = |one: usize| (one * turn).min(last);
    let cells: Vec<usize> = sampled
        .iter()
        .flat_map(|one| (0..turn).map(move |k| first_of(*one) + k))
        .collect();
    let found = sample(path, grid, &cells)?;
    let largest = |from: usize| (0..turn).map(move |k| from * turn + k);
    let between = |cell: usize| {
        let after = sampled.partition_point(|one| first_of(*one) <= cell);
        let pair = [after.saturating_sub(1), after.min(sampled.len() - 1)];
        let both = pair.into_iter().flat_map(largest);
        both.fold(CellMotion::default(), |all, i| all.and(&found[i]))
    };
    Ok((0..grid.cells).map(between).collect())
}

/// The motion of these cells.
fn sample(path: &Path<'_>, grid: &Grid, cells: &[usize]) -> Result<Vec<CellMotion>> {
    let mut found = Vec::with_capacity(cells.len());
    let (mut x, mut z) = (Vec::new(), Vec::new());
    let reach = 0.5 * TAU * grid.step() / SAMPLES as f64;
    for cells in cells.chunks(BATCH / SAMPLES) {
        let place =
            |cell: usize, k: usize| (cell as f64 + (k as f64 + 0.5) / SAMPLES as f64) * grid.step();
        let places = cells
            .iter()
            .flat_map(|cell| (0..SAMPLES).map(move |k| place(*cell, k)));
        let n: Vec<f64> = places.collect();
        x.resize(n.len(), [f64::NAN; 5]);
        z.resize(n.len(), [f64::NAN; 5]);
        path.series_at(&n, &mut x, &mut z)?;
        if let Some(i) = (0..n.len()).find(|i| !is_finite(&x[*i]) || !is_finite(&z[*i])) {
            return Err(no_value(n[i], path.radius_at(n[i])));
        }
        for (x, z) in x.chunks(SAMPLES).zip(z.chunks(SAMPLES)) {
            let mut cell = CellMotion::default();
            x.iter().zip(z).for_each(|(x, z)| cell.include(x, z, reach));
            found.push(cell);
        }
    }
    Ok(found)
}

/// Whether the value and the first three derivatives are numbers.
fn is_finite(series: &Series) -> bool {
    series[..4].iter().all(|c| c.is_finite())
}

fn no_value(n: f64, rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the path's derivatives are no numbers at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}
