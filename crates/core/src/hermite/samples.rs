//! |φ⁗| along the path on an even grid of angles, in batches as the steps advance.
//!
//! Where a sample [stands alone](PhiEvaluator::stands_alone), one of [`STRIDE`] is evaluated at first, and the others
//! are estimated. Only those that may be the largest of their step are evaluated then.

use std::f64::consts::TAU;
use std::ops::Range;

use super::clock::Clock;
use super::estimate::{AROUND, Estimate, REACH, STRIDE, within};
use super::knots::Knot;
use super::phi::PhiEvaluator;
use crate::{Path, Result, Revolutions};

/// Samples on a revolution of the coarsest grid. The number is a prime, so that no ring of equal
/// features has all its samples at the same phase.
const COARSEST: f64 = 367.0;
/// Number of samples in a batch.
const BATCH: usize = 256;
/// Number of cells that are estimated together.
const CELLS: usize = 96;
/// Samples that are no longer needed are dropped, so many at a time.
const DROPPED: usize = 4096;

/// |φ⁗|, or |X⁗| in its measure, on the grid around the current step.
pub(super) struct Samples<'a> {
    phi: PhiEvaluator<'a>,
    block: Revolutions,
    /// The grid's spacing, in revolutions.
    spacing: f64,
    /// Whether samples are estimated at first.
    estimates: bool,
    /// Number of the first sample in the buffer. Sample i lies at block.start + i·spacing. Where samples are
    /// estimated, it is the first of a cell.
    first: usize,
    fourth: Vec<Estimate>,
    /// [`PhiEvaluator::signed_fourths`] of the first sample of each cell, from the cell `first_corner` on.
    corners: [Vec<f64>; 2],
    first_corner: usize,
    n: Vec<f64>,
}

impl<'a> Samples<'a> {
    /// Samples for steps of at most `max_step` rad, with errors of at most `allowed` mm. X's own
    /// error may take `feed_part` of the distance between passes. No sample is evaluated yet.
    pub(super) fn new(
        path: &Path<'a>,
        block: Revolutions,
        (max_step, feed_part): (f64, f64),
        allowed: f64,
    ) -> Self {
        let phi = PhiEvaluator::new(path, block, (max_step, feed_part), allowed);
        Self {
            estimates: phi.stands_alone(block),
            phi,
            block,
            spacing: 1.0 / COARSEST,
            first: 0,
            fourth: Vec::new(),
            corners: Default::default(),
            first_corner: 0,
            n: Vec::new(),
        }
    }

    /// How the lengths of steps are measured.
    pub(super) fn clock(&self) -> Clock<'a> {
        self.phi.clock
    }

    /// The grid's spacing, rad.
    pub(super) fn spacing(&self) -> f64 {
        TAU * self.spacing
    }

    /// Whether the grid is the coarsest one.
    pub(super) fn is_coarsest(&self) -> bool {
        self.spacing >= 1.0 / COARSEST
    }

    /// Scales the spacing and starts anew.
    pub(super) fn rescale(&mut self, factor: f64) {
        self.spacing *= factor;
        self.fourth.clear();
        self.clear_corners();
    }

    /// The knots of both laws within the block.
    pub(super) fn knots(&mut self) -> Result<Vec<Knot>> {
        self.phi.knots(self.block)
    }

    /// Position of sample `i`, in revolutions. The last samples lie at the block's end.
    pub(super) fn position(&self, i: usize) -> f64 {
        (self.block.start + i as f64 * self.spacing).min(self.block.end)
    }

    /// The number of the sample at or before `n`.
    pub(super) fn at_or_before(&self, n: f64) -> usize {
        let near = ((n - self.block.start) / self.spacing).floor().max(0.0) as usize;
        match self.position(near) > n {
            true => near.saturating_sub(1),
            false => near,
        }
    }

    /// The number of the sample at or before `n`. Samples before it are no longer needed.
    pub(super) fn begin(&mut self, n: f64) -> usize {
        let start = self.at_or_before(n);
        if start < self.first || start >= self.first + self.fourth.len() {
            self.fourth.clear();
            self.clear_corners();
            self.first = match self.estimates {
                true => start - start % STRIDE,
                false => start,
            };
        } else if start - self.first >= DROPPED {
            self.fourth.drain(..DROPPED);
            self.first += DROPPED;
        }
        start
    }

    /// What is known of sample `i`, which must not lie before the result of the last [`begin`](Self::begin).
    pub(super) fn estimate(&mut self, i: usize) -> Result<Estimate> {
        while self.first + self.fourth.len() <= i {
            match self.estimates {
                true => self.load_cells()?,
                false => self.load()?,
            }
        }
        Ok(self.fourth[i - self.first])
    }

    /// What is known of sample `i`, if anything is known yet.
    pub(super) fn known(&self, i: usize) -> Option<Estimate> {
        self.fourth.get(i.checked_sub(self.first)?).copied()
    }

    /// Adds those of the samples that are not exact and may be the largest, and at least `floor`.
    pub(super) fn add_rivals(&self, samples: Range<usize>, floor: f64, rivals: &mut Vec<usize>) {
        let known = || samples.clone().filter_map(|i| Some((i, self.known(i)?)));
        let floor = known()
            .map(|(_, sample)| sample.lower)
            .fold(floor, f64::max);
        let may_be_largest = |sample: &Estimate| !sample.is_exact() && sample.upper >= floor;
        rivals.extend(
            known()
                .filter(|(_, sample)| may_be_largest(sample))
                .map(|(i, _)| i),
        );
    }

    /// Those of the samples that are exact.
    pub(super) fn exact(&self, samples: Range<usize>) -> impl Iterator<Item = f64> {
        let known = samples.filter_map(|i| self.known(i));
        known.filter(Estimate::is_exact).map(|sample| sample.upper)
    }

    /// Evaluates these samples, of which something is known.
    pub(super) fn make_exact(&mut self, samples: &[usize]) -> Result<()> {
        let fourth = self.fourths(samples.iter().copied())?;
        for (i, fourth) in samples.iter().zip(fourth) {
            self.fourth[i - self.first] = Estimate::exact(fourth);
        }
        Ok(())
    }

    /// The next batch, all of it exact.
    fn load(&mut self) -> Result<()> {
        let from = self.first + self.fourth.len();
        let exact = self.fourths(from..from + BATCH)?;
        self.fourth.extend(exact.into_iter().map(Estimate::exact));
        Ok(())
    }

    /// The next cells. Samples whose cell has too few others around it within the block are exact.
    fn load_cells(&mut self) -> Result<()> {
        let first_cell = (self.first + self.fourth.len()) / STRIDE;
        let whole = self.at_or_before(self.block.end) / STRIDE;
        let end = (first_cell + CELLS).min(whole + 2).max(first_cell + 1);
        let cells = first_cell..end;
        self.load_corners(
            first_cell.saturating_sub(REACH),
            (cells.end + REACH).min(whole),
        )?;
        let mut missing = Vec::new();
        for cell in cells {
            let from = cell * STRIDE;
            match self.estimate_cell(cell) {
                Some(cell) => self.fourth.extend(cell),
                None => {
                    missing.extend(from..from + STRIDE);
                    self.fourth.extend([Estimate::exact(f64::NAN); STRIDE]);
                }
            }
        }
        match missing.is_empty() {
            true => Ok(()),
            false => self.make_exact(&missing),
        }
    }

    /// Evaluates the first samples of the cells from `from` to `to`, as far as they are not known yet.
    fn load_corners(&mut self, from: usize, to: usize) -> Result<()> {
        let held = self.corners[0].len();
        if held == 0 {
            self.first_corner = from;
        }
        let dropped = from.saturating_sub(self.first_corner).min(held);
        for column in &mut self.corners {
            column.drain(..dropped);
        }
        self.first_corner += dropped;
        let next = self.first_corner + self.corners[0].len();
        let n = self.evaluate((next..=to).map(|cell| cell * STRIDE))?;
        for (i, n) in n.iter().enumerate() {
            for (column, fourth) in self.corners.iter_mut().zip(self.phi.signed_fourths(i, *n)) {
                column.push(fourth);
            }
        }
        self.n = n;
        Ok(())
    }

    fn clear_corners(&mut self) {
        for column in &mut self.corners {
            column.clear();
        }
    }

    /// The samples of a cell, if enough of the others are known around it.
    fn estimate_cell(&self, cell: usize) -> Option<[Estimate; STRIDE]> {
        let from = cell.checked_sub(REACH)?.checked_sub(self.first_corner)?;
        let [phi, x] = &self.corners;
        let around: [&[f64; AROUND]; 2] = [
            phi.get(from..)?.first_chunk()?,
            x.get(from..)?.first_chunk()?,
        ];
        let corner = around.map(|around| around[REACH].abs());
        let within = within(around, self.phi.sharpest);
        let corner = Estimate::exact(corner[0].max(corner[1]).min(self.phi.sharpest));
        Some(std::array::from_fn(|i| match i {
            0 => corner,
            _ => within[i - 1],
        }))
    }

    /// |φ⁗| at these samples.
    fn fourths(&mut self, samples: impl Iterator<Item = usize>) -> Result<Vec<f64>> {
        let n = self.evaluate(samples)?;
        let fourths = n.iter().enumerate().map(|(i, n)| self.phi.fourth(i, *n));
        let fourths = fourths.collect();
        self.n = n;
        Ok(fourths)
    }

    /// Evaluates φ at these samples, and gives their positions, which belong back into `n`.
    fn evaluate(&mut self, samples: impl Iterator<Item = usize>) -> Result<Vec<f64>> {
        let mut n = std::mem::take(&mut self.n);
        n.clear();
        n.extend(samples.map(|i| self.position(i)));
        if !n.is_empty() {
            self.phi.evaluate(&n)?;
        }
        Ok(n)
    }
}
