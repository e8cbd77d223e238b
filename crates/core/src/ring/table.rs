//! F(ρ), the feed that keeps the residual at every angle, tabulated against the radius.

use std::iter::once;

use super::{Measure, least_over_angles_at};
use crate::{Locus, Misfit, RadialRange, Result, Setup, StrategyError};

/// Cells of the first table.
const FEWEST_CELLS: usize = 256;
/// The table is no longer halved at this number of cells.
const MOST_CELLS: usize = 4096;
/// The same limit if the nose may leave seams. The feed has kinks there that no table resolves, and
/// every evaluation of the feed is a scan of the edge.
const MOST_CELLS_OVER_SEAMS: usize = FEWEST_CELLS;
/// Cells are halved while their floors lie further below the feed than this, relatively and on
/// average over the table. This is what the table costs in revolutions.
const TABLE_COST: f64 = 1e-4;
/// Where a cell is probed, as a part of its width. The golden section is in step with nothing.
const PROBE: f64 = 0.381_966;
/// A probe that lies below its floor by less than this part of F lowers the floors of its cell, but does not
/// halve the cells. Searches for F end with steps of this size, and over a flat part F differs by rounding
/// alone. What a ripple in step with the cells takes away unseen is far below the margin of any law.
const UNSEEN: f64 = 1e-8;
/// Parts of a cell, each with a floor of its own. They give more borders without more evaluations.
pub const FLOORS: usize = 8;

/// Radii at which feeds are looked for together: most questions of a search are for six points, which leave
/// vector registers empty, and those of sixteen radii fill them.
pub const RADII_AT_ONCE: usize = 16;

/// F at one radius, mm.
pub type FeedAt<'a> = dyn Fn(f64) -> Result<f64> + 'a;
/// F at each of some radii, mm.
type FeedsAt<'a> = dyn Fn(&[f64]) -> Result<Vec<f64>> + 'a;

/// F at equal steps of ρ, and floors below F in every cell between them.
#[derive(Debug, Clone)]
pub struct FeedTable {
    /// Radius at which the first cell begins, mm.
    pub from: f64,
    /// Width of a cell, mm.
    pub step: f64,
    /// F at the cells' borders, mm.
    pub feed: Vec<f64>,
    /// A lower limit of F in each eighth of a cell, as far as the cells resolve F, mm.
    pub floor: Vec<f64>,
    /// Whether the table begins at the axis. Then F(−ρ) = F(ρ).
    pub even: bool,
}

impl FeedTable {
    /// Tabulates the feed that keeps the residual at every angle, over the task's range.
    ///
    /// # Errors
    /// If the range has no length, or if the surface or the locus has no value.
    pub fn for_residual(setup: Setup<'_>) -> Result<Self> {
        let most = match setup.task.tool.misfit {
            Misfit::Refuse => MOST_CELLS,
            Misfit::CutWhatFits => MOST_CELLS_OVER_SEAMS,
        };
        Self::within(setup.task.range, most, &|radii| {
            least_residual_feeds(setup, radii)
        })
    }

    /// Tabulates a feed that has one value at each radius, over a range.
    ///
    /// # Errors
    /// If the range has no length. The errors of `feed_at`.
    pub fn tabulate(range: RadialRange, feed_at: &FeedAt<'_>) -> Result<Self> {
        Self::within(range, MOST_CELLS, &|radii| {
            radii.iter().map(|rho| feed_at(*rho)).collect()
        })
    }

    fn within(range: RadialRange, most: usize, feeds_at: &FeedsAt<'_>) -> Result<Self> {
        let RadialRange { inner, outer } = range;
        if !(inner.is_finite() && outer.is_finite() && inner < outer) {
            return Err(StrategyError::failed(format!(
                "there is nothing to cut: ρ runs from {inner} mm to {outer} mm"
            )));
        }
        let even = inner <= 0.0;
        let (from, to) = if even {
            (0.0, outer.max(-inner))
        } else {
            (inner, outer)
        };
        let step = (to - from) / FEWEST_CELLS as f64;
        // The last border is the end itself, without the rounding of a sum.
        let borders = (0..FEWEST_CELLS).map(|i| from + i as f64 * step);
        let borders: Vec<f64> = borders.chain(once(to)).collect();
        let mut table = Self {
            from,
            step,
            feed: feeds_at(&borders)?,
            floor: Vec::new(),
            even,
        };
        table.set_floors();
        while table.cells() < most {
            let is_dear = table.cost() > TABLE_COST;
            if !is_dear && !table.lower_floors(feeds_at)? {
                // No probe lies below its floor by more than searches for F leave open.
                return Ok(table);
            }
            table.halve(feeds_at)?;
            table.set_floors();
        }
        table.lower_floors(feeds_at)?;
        Ok(table)
    }

    /// Probes every cell at an inner point that is out of step with the borders, so that a ripple
    /// in step with the cells shows there. Lowers the floors of the cells in which F lies below
    /// them, and returns whether it lies below any of them by more than [`UNSEEN`].
    fn lower_floors(&mut self, feeds_at: &FeedsAt<'_>) -> Result<bool> {
        let probe = |cell: usize| self.from + (cell as f64 + PROBE) * self.step;
        let probes: Vec<f64> = (0..self.cells()).map(probe).collect();
        let mut any = false;
        for (found, floors) in feeds_at(&probes)?
            .into_iter()
            .zip(self.floor.chunks_mut(FLOORS))
        {
            let floor = floors.get((PROBE * FLOORS as f64) as usize).copied();
            if let Some(through) = floor.map(|floor| floor - found).filter(|by| *by > 0.0) {
                any |= through > UNSEEN * found;
                for floor in floors {
                    *floor = (*floor - 2.0 * through).max(0.5 * found);
                }
            }
        }
        Ok(any)
    }

    fn cells(&self) -> usize {
        self.feed.len() - 1
    }

    /// The largest F in the table, mm.
    pub fn largest(&self) -> f64 {
        self.feed
            .iter()
            .fold(0.0, |largest, feed| feed.max(largest))
    }

    /// The range of radii that the table covers, mm.
    pub fn range(&self) -> (f64, f64) {
        (self.from, self.from + self.step * self.cells() as f64)
    }

    /// The least floor between two radii, as far as the table reaches, mm.
    pub fn least(&self, from: f64, to: f64) -> f64 {
        let width = self.step / FLOORS as f64;
        let last = self.floor.len().saturating_sub(1);
        let cell = |rho: f64| (((rho - self.from) / width).floor().max(0.0) as usize).min(last);
        let (from, to) = match self.even {
            // F(−ρ) = F(ρ).
            true if from < 0.0 => (0.0, to.max(-from)),
            _ => (from, to),
        };
        let floors = self.floor.get(cell(from)..=cell(to)).unwrap_or_default();
        floors
            .iter()
            .fold(f64::INFINITY, |least, floor| floor.min(least))
    }

    /// ∫ dρ/F over the table: the revolutions of the fastest law that keeps the residual.
    pub fn fewest_revolutions(&self) -> f64 {
        let turns = |pair: &[f64]| 0.5 / pair[0] + 0.5 / pair[1];
        self.step * self.feed.windows(2).map(turns).sum::<f64>()
    }

    /// F at `rho`, from the cubic through the four borders around it.
    pub fn value(&self, rho: f64) -> f64 {
        let place = ((rho - self.from) / self.step).clamp(0.0, self.cells() as f64);
        let first = (place.floor() as usize)
            .saturating_sub(1)
            .min(self.feed.len().saturating_sub(4));
        let t = place - first as f64;
        let Some([a, b, c, d]) = self.feed.get(first..first + 4) else {
            return f64::NAN;
        };
        let (t1, t2, t3) = (t - 1.0, t - 2.0, t - 3.0);
        (d * t * t1 * t2 - a * t1 * t2 * t3) / 6.0 + (b * t * t2 * t3 - c * t * t1 * t3) / 2.0
    }

    fn halve(&mut self, feeds_at: &FeedsAt<'_>) -> Result<()> {
        self.step *= 0.5;
        let middle = |cell: usize| self.from + (2 * cell + 1) as f64 * self.step;
        let middles: Vec<f64> = (0..self.cells()).map(middle).collect();
        let mut between = feeds_at(&middles)?.into_iter();
        let mut feed = Vec::with_capacity(self.feed.len() + middles.len());
        for known in &self.feed {
            feed.push(*known);
            feed.extend(between.next());
        }
        self.feed = feed;
        Ok(())
    }

    /// The largest |second difference| of F around a cell.
    fn bend(&self, cell: usize) -> f64 {
        let second = |i: usize| match self.feed.get(i.saturating_sub(1)..i + 2) {
            Some([before, at, after]) if i > 0 => (before - 2.0 * at + after).abs(),
            _ => 0.0,
        };
        (cell.saturating_sub(1)..cell + 3).fold(0.0, |most: f64, i| most.max(second(i)))
    }

    /// Sets the floors of all cells. Within a cell a parabola falls below its chord by at most an
    /// eighth of its second difference. The floor takes twice that, with the largest second
    /// difference around the cell. It therefore also holds where F changes from one angle's branch
    /// to another's, which is an arch above the chord.
    fn set_floors(&mut self) {
        let mut floor = Vec::with_capacity(FLOORS * self.cells());
        for (cell, ends) in self.feed.windows(2).enumerate() {
            let sag = 0.25 * self.bend(cell);
            let chord = |i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / FLOORS as f64;
            for i in 0..FLOORS {
                let lower = chord(i).min(chord(i + 1));
                floor.push((lower - sag).max(0.5 * lower));
            }
        }
        self.floor = floor;
    }

    /// The relative distance of the floors below the feed, on average.
    fn cost(&self) -> f64 {
        let cells = self.feed.windows(2).enumerate();
        let lost: f64 = cells
            .map(|(cell, ends)| 0.5 * self.bend(cell) / (ends[0] + ends[1]))
            .sum();
        lost / self.cells() as f64
    }
}

/// The least residual feed over all angles at each radius. A locus that looks for them itself may do so in
/// parallel.
fn least_residual_feeds(setup: Setup<'_>, radii: &[f64]) -> Result<Vec<f64>> {
    let (locus, residual) = (setup.locus, setup.task.tolerance.residual);
    let mut least = vec![f64::NAN; radii.len()];
    if let Some(answer) = locus.least_residual_feeds(residual, radii, &mut least) {
        return answer.map(|()| least);
    }
    let groups = radii.chunks(RADII_AT_ONCE);
    let groups = groups.map(|radii| least_feeds_at(locus, residual, radii));
    groups
        .collect::<Result<Vec<_>>>()
        .map(|found| found.concat())
}

/// The least feed over all angles at each of some radii, mm, that leaves cusps of height `residual`, mm. Some
/// [`RADII_AT_ONCE`] of them at a time cost the least.
///
/// # Errors
/// If the surface or the locus has no value there: that of the first such radius.
pub fn least_feeds_at(locus: &dyn Locus, residual: f64, radii: &[f64]) -> Result<Vec<f64>> {
    let radial = locus.radial();
    let measure: &Measure<'_> =
        &|theta, rho, out| locus.residual_feed(residual, radial, theta, rho, out);
    least_over_angles_at(measure, radii)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::f64::consts::TAU;

    use super::*;
    use crate::Scalar;

    const RANGE: RadialRange = RadialRange {
        inner: 0.0,
        outer: 2.0,
    };

    /// The table of a feed, and at how many radii it asked for the feed.
    fn tabulated(feed: impl Fn(f64) -> f64) -> (FeedTable, usize) {
        let asked = Cell::new(0);
        let table = FeedTable::tabulate(RANGE, &|rho| {
            asked.set(asked.get() + 1);
            Ok(feed(rho))
        });
        (table.unwrap(), asked.get())
    }

    /// A number between 0 and 1 that is different at each radius.
    fn noise(rho: f64) -> f64 {
        let mixed = (rho.to_bits() >> 12).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 32) as f64 / f64::from(u32::MAX)
    }

    #[test]
    fn a_constant_feed_with_rounding_noise_is_asked_for_at_the_first_cells_alone() {
        for part in [0.0, 1e-15, 1e-12, 1e-9] {
            let feed = |rho: f64| 0.02 * (1.0 + part * noise(rho));
            let (table, asked) = tabulated(feed);
            // The borders of the cells, and a probe in each.
            assert_eq!(asked, 2 * FEWEST_CELLS + 1, "{part}");
            for (cell, floors) in table.floor.chunks(FLOORS).enumerate() {
                let probe = feed((cell as f64 + PROBE) * table.step);
                let floor = floors[(PROBE * FLOORS as f64) as usize];
                assert!(floor <= probe, "{part}: {floor} for {probe}");
            }
        }
    }

    #[test]
    fn a_small_ripple_in_step_with_the_first_cells_halves_them() {
        let waves = FEWEST_CELLS as f64 / RANGE.outer;
        let feed = |rho: f64| 0.02 * (1.0 + 1e-7 * Scalar::cos(TAU * waves * rho));
        let (table, asked) = tabulated(feed);
        assert!(table.cells() > FEWEST_CELLS && asked > 2 * FEWEST_CELLS + 1);
        for i in 0..10_000 {
            let rho = RANGE.outer * (f64::from(i) + 0.5) / 10_000.0;
            assert!(table.least(rho, rho) <= feed(rho), "{rho}");
        }
    }
}
