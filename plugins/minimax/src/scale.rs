//! The natural step along a span: how long a step is that takes the tolerance on both sides.

use turnpath_plugin::prelude::*;

use crate::grid::{Sample, natural_step};

/// Bins in the width of the median natural step. The window of the largest |φ⁗| has this many, and
/// the Gaussian that smooths the steps has half as many as its standard deviation.
const BINS: usize = 4;
/// Binomial weights of 16: a Gaussian with a standard deviation of two bins.
const WEIGHTS: [f64; 17] = [
    1.0, 16.0, 120.0, 560.0, 1820.0, 4368.0, 8008.0, 11440.0, 12870.0, 11440.0, 8008.0, 4368.0,
    1820.0, 560.0, 120.0, 16.0, 1.0,
];

/// The natural step at each place of a span, in revolutions.
pub struct Scale {
    start: f64,
    /// Width of a bin, in revolutions.
    bin: f64,
    steps: Vec<f64>,
}

impl Scale {
    /// The natural steps between the first and the last of `samples`, none longer than `largest`
    /// revolutions.
    pub fn new(samples: &[Sample], allowed: f64, largest: f64) -> Self {
        let [start, end] = [samples.first(), samples.last()].map(|s| s.map_or(0.0, |s| s.n));
        let natural = |fourth: f64| (natural_step(allowed, fourth) / TAU).min(largest);
        let mut every: Vec<f64> = samples.iter().map(|s| natural(fourth(s))).collect();
        let middle = every.len() / 2;
        let median = match every.is_empty() {
            true => largest,
            false => *every.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        let count = ((end - start) / median * BINS as f64).ceil().max(1.0);
        let bin = ((end - start) / count).max(f64::MIN_POSITIVE);
        let highest = highest(samples, start, bin, count as usize);
        let steps: Vec<f64> = (0..highest.len())
            .map(|k| natural(around(&highest, k, BINS / 2).fold(0.0, f64::max)))
            .collect();
        Self {
            start,
            bin,
            steps: smooth(&steps),
        }
    }

    /// The natural step at `n`, in revolutions.
    pub fn at(&self, n: f64) -> f64 {
        let place = ((n - self.start) / self.bin - 0.5).clamp(0.0, (self.steps.len() - 1) as f64);
        let low = place as usize;
        let high = (low + 1).min(self.steps.len() - 1);
        let part = place - low as f64;
        self.steps[low] + part * (self.steps[high] - self.steps[low])
    }
}

/// |Z⁗| at a place, mm/rad⁴.
fn fourth(sample: &Sample) -> f64 {
    24.0 * sample.z[4].abs()
}

/// The largest |Z⁗| in each bin. A bin between two places has that of both.
fn highest(samples: &[Sample], start: f64, bin: f64, count: usize) -> Vec<f64> {
    let mut highest = vec![0.0f64; count];
    let index = |n: f64| (((n - start) / bin) as usize).min(count - 1);
    for pair in samples.windows(2) {
        let larger = fourth(&pair[0]).max(fourth(&pair[1]));
        for value in &mut highest[index(pair[0].n)..=index(pair[1].n)] {
            *value = value.max(larger);
        }
    }
    highest
}

/// The values within `reach` of index `k`.
fn around(values: &[f64], k: usize, reach: usize) -> impl Iterator<Item = f64> + '_ {
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
