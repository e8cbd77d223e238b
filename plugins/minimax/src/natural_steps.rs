//! The natural step along a span: how long a step is that takes what it may err by.
//!
//! It takes the tolerance of Z on both sides, unless X's own error or the largest step allows less.
//! Then a node has nothing to gain beside the path, and would only shake Z. So nodes lie off the
//! locus by no more than the error that a natural step leaves.

use turnpath_plugin::prelude::*;

use crate::grid::{Sample, natural_step, on_locus_step};
use crate::table::Table;

/// Bins in the width of the median natural step. The window of the largest |φ⁗| has this many, and
/// the Gaussian that smooths the steps has half as many as its standard deviation.
const BINS: usize = 4;
/// Binomial weights of 16: a Gaussian with a standard deviation of two bins.
const WEIGHTS: [f64; 17] = [
    1.0, 16.0, 120.0, 560.0, 1820.0, 4368.0, 8008.0, 11440.0, 12870.0, 11440.0, 8008.0, 4368.0,
    1820.0, 560.0, 120.0, 16.0, 1.0,
];

/// The natural step at each place of a span.
pub struct NaturalSteps {
    start: f64,
    /// Width of a bin, in revolutions.
    bin: f64,
    /// In revolutions.
    steps: Vec<f64>,
    /// The part of the tolerance that a step of this length takes on both sides.
    parts: Vec<f64>,
    /// The largest |φ⁗| of the span, mm/rad⁴.
    pub largest_fourth: f64,
}

/// What makes steps short at a place.
#[derive(Debug, Clone, Copy, Default)]
struct Bend {
    /// |φ⁗|, mm/rad⁴.
    fourth: f64,
    /// |X⁗| over the error that X may have, 1/rad⁴.
    of_x: f64,
}

impl Bend {
    fn and(self, other: Self) -> Self {
        Self {
            fourth: self.fourth.max(other.fourth),
            of_x: self.of_x.max(other.of_x),
        }
    }

    /// The natural step, in revolutions, and the part of the tolerance that it takes.
    fn step(self, allowed: f64, largest: f64) -> (f64, f64) {
        let of_z = natural_step(allowed, self.fourth) / TAU;
        let of_x = on_locus_step(1.0, self.of_x) / TAU;
        let step = of_z.min(of_x).min(largest);
        let ratio = (step / of_z) * (step / of_z);
        (step, ratio * ratio)
    }
}

impl NaturalSteps {
    /// The natural steps between the first and the last of `samples`, of which `table` is made.
    pub fn new(samples: &[Sample], table: &Table<'_>) -> Self {
        let [start, end] = [samples.first(), samples.last()].map(|s| s.map_or(0.0, |s| s.n));
        let (allowed, largest) = (table.limits.allowed, table.limits.max_step);
        let bends: Vec<Bend> = samples
            .iter()
            .enumerate()
            .map(|(k, sample)| bend(sample, k, table))
            .collect();
        let mut every: Vec<f64> = bends.iter().map(|b| b.step(allowed, largest).0).collect();
        let middle = every.len() / 2;
        let median = match every.is_empty() {
            true => largest,
            false => *every.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        let count = ((end - start) / median * BINS as f64).ceil().max(1.0);
        let bin = ((end - start) / count).max(f64::MIN_POSITIVE);
        let highest = highest(samples, &bends, (start, bin), count as usize);
        let (steps, parts): (Vec<f64>, Vec<f64>) = (0..highest.len())
            .map(|k| {
                let window = around(&highest, k, BINS / 2);
                window
                    .fold(Bend::default(), Bend::and)
                    .step(allowed, largest)
            })
            .unzip();
        Self {
            start,
            bin,
            steps: smooth(&steps),
            parts: smooth(&parts),
            largest_fourth: bends.iter().map(|bend| bend.fourth).fold(0.0, f64::max),
        }
    }

    /// The natural step at `n`, in revolutions.
    pub fn at(&self, n: f64) -> f64 {
        self.between(&self.steps, n)
    }

    /// The part of the tolerance that a natural step at `n` takes on both sides: 1, or less where X
    /// or the largest step allows no longer one.
    pub fn part_at(&self, n: f64) -> f64 {
        self.between(&self.parts, n)
    }

    fn between(&self, values: &[f64], n: f64) -> f64 {
        let place = ((n - self.start) / self.bin - 0.5).clamp(0.0, (values.len() - 1) as f64);
        let low = place as usize;
        let high = (low + 1).min(values.len() - 1);
        let part = place - low as f64;
        values[low] + part * (values[high] - values[low])
    }
}

/// The bend at place `k` of the table. Where X's own error matters, it moves the place at which Z is
/// compared, so that φ⁗ = Z⁗ − ∂Z/∂X·X⁗.
fn bend(sample: &Sample, k: usize, table: &Table<'_>) -> Bend {
    let [x, z] = [&sample.x, &sample.z].map(|series| 24.0 * series[4]);
    if !table.x_matters {
        return Bend {
            fourth: z.abs(),
            of_x: 0.0,
        };
    }
    let [slope, _, weight] = table.coupling_near(k);
    Bend {
        fourth: (z - slope * x).abs(),
        of_x: x.abs() * weight,
    }
}

/// The largest bend in each bin. A bin between two places has that of both.
fn highest(
    samples: &[Sample],
    bends: &[Bend],
    (start, bin): (f64, f64),
    count: usize,
) -> Vec<Bend> {
    let mut highest = vec![Bend::default(); count];
    let index = |n: f64| (((n - start) / bin) as usize).min(count - 1);
    for (pair, bends) in samples.windows(2).zip(bends.windows(2)) {
        let larger = bends[0].and(bends[1]);
        for value in &mut highest[index(pair[0].n)..=index(pair[1].n)] {
            *value = value.and(larger);
        }
    }
    highest
}

/// The values within `reach` of index `k`.
fn around(values: &[Bend], k: usize, reach: usize) -> impl Iterator<Item = Bend> + '_ {
    let to = (k + reach + 1).min(values.len());
    values[k.saturating_sub(reach)..to].iter().copied()
}

/// The values, averaged with [`WEIGHTS`]. Beyond the ends the last value goes on.
fn smooth(values: &[f64]) -> Vec<f64> {
    let (half, last) = (WEIGHTS.len() / 2, values.len() - 1);
    let total: f64 = WEIGHTS.iter().sum();
    let at = |k: usize| {
        let terms = WEIGHTS.iter().enumerate();
        let sum: f64 = terms
            .map(|(i, weight)| weight * values[(k + i).saturating_sub(half).min(last)])
            .sum();
        sum / total
    };
    (0..values.len()).map(at).collect()
}
