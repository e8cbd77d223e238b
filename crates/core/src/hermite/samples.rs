//! |φ⁗| along the path on an even grid of angles, in batches as the steps advance.
//!
//! Where values are [pointwise](PhiEvaluator::is_pointwise), one of [`STRIDE`] samples is evaluated at first: the corner of a
//! cell. The others are estimated. Only those that may be the largest of their step are evaluated then, and some
//! more, to see whether the estimates hold.

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
/// The same where no sample of a grid is known. The grid may turn out too coarse with the first step.
const FIRST_BATCH: usize = 32;
/// Number of cells that are estimated together.
const CELLS: usize = 96;
/// The same where no sample of a grid is known.
const FIRST_CELLS: usize = 16;
/// In one of so many cells a sample is evaluated to see whether its estimate holds.
const CHECKED: usize = 8;
/// Samples that are no longer needed are dropped, so many at a time.
const DROPPED: usize = 4096;

/// |φ⁗|, or |X⁗| in its measure, on the grid around the current step.
pub(super) struct Samples<'a> {
    phi: PhiEvaluator<'a>,
    block: Revolutions,
    /// The grid's spacing, in revolutions.
    spacing: f64,
    /// Whether a sample does not depend on those that are evaluated with it.
    is_pointwise: bool,
    /// Whether samples are estimated at first.
    estimates: bool,
    /// Whether each sample that was evaluated lay within the limits of its estimate.
    estimates_hold: bool,
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
    /// error may take `feed_part` of the distance between passes. With `estimates` samples are estimated where that is
    /// possible. No sample is evaluated yet.
    pub(super) fn new(
        path: &Path<'a>,
        block: Revolutions,
        (max_step, feed_part): (f64, f64),
        allowed: f64,
        estimates: bool,
    ) -> Self {
        let phi = PhiEvaluator::new(path, block, (max_step, feed_part), allowed);
        let is_pointwise = phi.is_pointwise(block);
        Self {
            is_pointwise,
            estimates: estimates && is_pointwise,
            estimates_hold: true,
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

    /// Whether steps are those of all samples, as far as the samples that were evaluated tell.
    pub(super) fn estimates_hold(&self) -> bool {
        self.estimates_hold && !(self.estimates && self.phi.x_has_mattered)
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

    /// Those of the samples of which something is known, and the number of the first one.
    fn known_of(&self, samples: Range<usize>) -> (usize, &[Estimate]) {
        let from = samples.start.max(self.first);
        let index = |i: usize| i.saturating_sub(self.first).min(self.fourth.len());
        let known = self.fourth.get(index(from)..index(samples.end));
        (from, known.unwrap_or_default())
    }

    /// Adds those of the samples that are not exact and may be the largest, and at least `floor`.
    pub(super) fn add_rivals(&self, samples: Range<usize>, floor: f64, rivals: &mut Vec<usize>) {
        let (first, known) = self.known_of(samples);
        let lower = known.iter().map(|sample| sample.lower);
        let floor = lower.fold(floor, f64::max);
        let may_be_largest = |sample: &Estimate| !sample.is_exact() && sample.upper >= floor;
        let numbered = (first..).zip(known);
        rivals.extend(
            numbered
                .filter(|(_, sample)| may_be_largest(sample))
                .map(|(i, _)| i),
        );
    }

    /// The values of those of the samples that are exact.
    pub(super) fn exact(&self, samples: Range<usize>) -> impl Iterator<Item = f64> {
        let known = self.known_of(samples).1.iter();
        known
            .filter(|sample| sample.is_exact())
            .map(|sample| sample.upper)
    }

    /// Evaluates these samples, of which something is known.
    pub(super) fn make_exact(&mut self, samples: &[usize]) -> Result<()> {
        let fourth = self.fourths(samples.iter().copied())?;
        for (i, fourth) in samples.iter().zip(fourth) {
            let known = &mut self.fourth[i - self.first];
            self.estimates_hold &= known.allows(fourth);
            *known = Estimate::exact(fourth);
        }
        Ok(())
    }

    /// The first number where no sample of the grid is known, else the other one.
    fn first_or(&self, first: usize, later: usize) -> usize {
        match self.fourth.is_empty() {
            true => first,
            false => later,
        }
    }

    /// The next batch, all of it exact.
    fn load(&mut self) -> Result<()> {
        let from = self.first + self.fourth.len();
        let behind_block = self.at_or_before(self.block.end) + 2;
        let to = match self.is_pointwise {
            // A sample depends on its batch, so the batch stays as it is.
            false => from + BATCH,
            true => (from + self.first_or(FIRST_BATCH, BATCH))
                .min(behind_block)
                .max(from + 1),
        };
        let exact = self.fourths(from..to)?;
        self.fourth.extend(exact.into_iter().map(Estimate::exact));
        Ok(())
    }

    /// The next cells. Samples of a cell with too few corners on one side within the block are exact.
    fn load_cells(&mut self) -> Result<()> {
        let first_cell = (self.first + self.fourth.len()) / STRIDE;
        let whole = self.at_or_before(self.block.end) / STRIDE;
        let end = (first_cell + self.first_or(FIRST_CELLS, CELLS))
            .min(whole + 2)
            .max(first_cell + 1);
        self.load_corners(first_cell.saturating_sub(REACH), (end + REACH).min(whole))?;
        let mut evaluated = Vec::new();
        for cell in first_cell..end {
            let from = cell * STRIDE;
            match self.estimate_cell(cell) {
                Some(estimates) => {
                    self.fourth.extend(estimates);
                    let checked = cell % CHECKED == 0;
                    evaluated.extend(checked.then(|| from + 1 + cell / CHECKED % (STRIDE - 1)));
                }
                None => {
                    self.fourth.extend([Estimate::UNKNOWN; STRIDE]);
                    evaluated.extend(from..from + STRIDE);
                }
            }
        }
        self.make_exact(&evaluated)
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
        if around
            .into_iter()
            .flatten()
            .any(|fourth| !fourth.is_finite())
        {
            return None;
        }
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

    /// Evaluates φ at these samples, and gives their positions. The caller gives the vector back to `n`.
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
