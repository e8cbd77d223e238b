//! The exact path at places that are as dense as steps are short.

use turnpath_plugin::hermite::{MAX_STEP, SHORTEST};
use turnpath_plugin::prelude::*;

/// Cells on a revolution. The number is a prime, so that no ring of equal features has all its
/// places at the same phase.
const CELLS: f64 = 47.0;
/// The least number of places in a cell.
const FEWEST: usize = 8;
/// Cells that are evaluated in one call: so many that a call's own cost does not count, and few enough that
/// they stay in cache.
const TOGETHER: usize = 64;
/// The least number of places within a natural step. A cubic's error is flat where it is largest:
/// between so many places a trial step can hide less than 0.4 % of the tolerance.
const LEAST_IN_STEP: f64 = 24.0;
/// With [`Misfit::CutWhatFits`] no step needs to be shorter than this, rad. The path has a kink
/// where the nose passes from one side of a seam to the other, and no step is right there.
/// Refinement halves the segments that are too long there.
pub const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;
/// The error of a step with both ends ±ε off the path is ε where L⁴φ⁗ is this many ε.
const TWO_SIDED: f64 = 768.0;
/// That of a step with both ends on the path is ε where L⁴φ⁗ is this many ε.
const ONE_SIDED: f64 = 384.0;

/// One place: the series of the nose centre along the path, in rad.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Where it is, in revolutions.
    pub n: f64,
    /// The series of X.
    pub x: Series,
    /// The series of Z.
    pub z: Series,
}

/// A part of the span with places at even distances.
struct Cell {
    from: f64,
    to: f64,
    /// The places, the cell's end excluded.
    samples: Vec<Sample>,
    /// The largest |Z⁗| of the places, mm/rad⁴.
    fourth: f64,
}

impl Cell {
    fn positions(&self, parts: usize) -> impl Iterator<Item = f64> + use<> {
        let (from, width) = (self.from, self.to - self.from);
        (0..parts).map(move |k| from + width * k as f64 / parts as f64)
    }

    /// How many places a natural step of `length` rad asks for.
    fn parts_for(&self, length: f64) -> usize {
        let wanted = (TAU * (self.to - self.from) * LEAST_IN_STEP / length).ceil();
        (wanted as usize).next_power_of_two().max(FEWEST)
    }
}

/// The length of a step, rad, that takes the tolerance on both sides.
pub fn natural_step(allowed: f64, fourth: f64) -> f64 {
    (TWO_SIDED * allowed / fourth).sqrt().sqrt()
}

/// The length of a step, rad, that takes the tolerance with exact values and rates at both ends.
pub fn on_locus_step(allowed: f64, fourth: f64) -> f64 {
    (ONE_SIDED * allowed / fourth).sqrt().sqrt()
}

/// The places of one span.
pub struct Grid<'a> {
    path: &'a Path<'a>,
    allowed: f64,
    cells: Vec<Cell>,
}

impl<'a> Grid<'a> {
    /// The places between two borders, for steps whose error is at most `allowed` mm.
    ///
    /// # Errors
    /// If the path has no 4th derivative, or needs steps that are too short.
    pub fn new(path: &'a Path<'a>, span: Revolutions, allowed: f64) -> Result<Self> {
        let count = ((span.end - span.start) * CELLS).ceil().max(1.0) as usize;
        let width = (span.end - span.start) / count as f64;
        let border = |k: usize| match k {
            k if k == count => span.end,
            k => span.start + k as f64 * width,
        };
        let cell = |k: usize| Cell {
            from: border(k),
            to: border(k + 1),
            samples: Vec::new(),
            fourth: 0.0,
        };
        let mut grid = Self {
            path,
            allowed,
            cells: (0..count).map(cell).collect(),
        };
        grid.fill()?;
        Ok(grid)
    }

    /// Doubles the places of cells until every natural step has enough of them.
    fn fill(&mut self) -> Result<()> {
        let mut wanted = vec![FEWEST; self.cells.len()];
        loop {
            let short: Vec<usize> = (0..self.cells.len())
                .filter(|k| self.cells[*k].samples.len() < wanted[*k])
                .collect();
            if short.is_empty() {
                return Ok(());
            }
            for cells in short.chunks(TOGETHER) {
                self.evaluate(cells, &wanted)?;
            }
            for (k, wanted) in wanted.iter_mut().enumerate() {
                *wanted = self.parts_wanted(k)?;
            }
        }
    }

    /// How many places a cell needs, from its own 4th derivative and its neighbours'.
    fn parts_wanted(&self, k: usize) -> Result<usize> {
        let around = &self.cells[k.saturating_sub(1)..(k + 2).min(self.cells.len())];
        let fourth = around.iter().map(|cell| cell.fourth).fold(0.0, f64::max);
        let natural = natural_step(self.allowed, fourth);
        if natural >= SHORTEST {
            return Ok(self.cells[k].parts_for(natural));
        }
        match self.path.task.tool.misfit {
            Misfit::Refuse => Err(too_short(self.cells[k].from, natural)),
            Misfit::CutWhatFits => Ok(self.cells[k].parts_for(LEAST_NEAR_SEAMS)),
        }
    }

    /// Evaluates these cells anew, with as many places as are wanted in each.
    fn evaluate(&mut self, cells: &[usize], wanted: &[usize]) -> Result<()> {
        let places = cells
            .iter()
            .flat_map(|k| self.cells[*k].positions(wanted[*k]));
        let n: Vec<f64> = places.collect();
        let blank = vec![[f64::NAN; 5]; n.len()];
        let (mut x, mut z) = (blank.clone(), blank);
        self.path.series_at(&n, &mut x, &mut z)?;
        let series = n.into_iter().zip(x).zip(z);
        let mut samples = series.map(|((n, x), z)| Sample { n, x, z });
        for k in cells {
            let of_cell = samples.by_ref().take(wanted[*k]);
            self.cells[*k].samples.clear();
            self.cells[*k].samples.extend(of_cell);
            self.measure(*k)?;
        }
        Ok(())
    }

    /// Finds the largest |Z⁗| of a cell.
    fn measure(&mut self, k: usize) -> Result<()> {
        let cell = &mut self.cells[k];
        cell.fourth = 0.0;
        for Sample { n, x, z } in &cell.samples {
            if !(x.iter().chain(z).all(|c| c.is_finite())) {
                return Err(no_value(*n, self.path.radius_at(*n)));
            }
            cell.fourth = cell.fourth.max(24.0 * z[4].abs());
        }
        if self.path.task.tool.misfit == Misfit::CutWhatFits {
            let squared = LEAST_NEAR_SEAMS * LEAST_NEAR_SEAMS;
            let largest = TWO_SIDED * self.allowed / (squared * squared);
            cell.fourth = cell.fourth.min(largest);
        }
        Ok(())
    }

    /// All places in order. The last one is the span's end, with the series of what ends there.
    pub fn into_samples(self) -> Result<Vec<Sample>> {
        let end = match self.cells.last() {
            Some(cell) => cell.to,
            None => return Ok(Vec::new()),
        };
        let last = sample_before(self.path, end)?;
        let mut samples: Vec<Sample> = Vec::new();
        for cell in self.cells {
            samples.extend(cell.samples);
        }
        samples.push(last);
        Ok(samples)
    }
}

/// The place at `n` with the series of the law's piece that ends there.
pub fn sample_before(path: &Path<'_>, n: f64) -> Result<Sample> {
    let (mut x, mut z) = ([[f64::NAN; 5]], [[f64::NAN; 5]]);
    let out = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    let theta = [angle(n), 1.0, 0.0, 0.0, 0.0];
    let rho = per_radian(path.law.series_before(n));
    path.locus.series(&[theta], &[rho], out)?;
    let ([x], [z]) = (x, z);
    if !x.iter().chain(&z).all(|c| c.is_finite()) {
        return Err(no_value(n, path.radius_at(n)));
    }
    Ok(Sample { n, x, z })
}

fn no_value(n: f64, rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the path's 4th derivative is not a number at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}

/// The error that the path needs steps below the shortest.
pub fn too_short(n: f64, natural: f64) -> StrategyError {
    MAX_STEP.refused(format!(
        "the tolerance needs steps of {:.2e} deg at C = {:.3} deg, but the shortest allowed step \
         is {:.3} deg: the tool centre's path is not smooth there; choose a larger interpolation \
         tolerance, a smaller tool, or another sampler",
        natural / DEG,
        360.0 * n,
        SHORTEST / DEG
    ))
}
