//! Estimates of even samples from each eighth of them.
//!
//! A sample is estimated by the polynomial through the eight nearest exact ones. Each exact sample is also estimated
//! from exact ones on both sides, which lie twice as far apart. Where the curve is smooth, this estimate errs 256 times
//! as much as those within a cell. Where it is not smooth, this estimate shows it. A wave of less than two exact samples a period can pass unseen, until a sample
//! between them is evaluated.

/// One sample of so many is exact.
pub(super) const STRIDE: usize = 8;
/// The exact samples beyond each end of a cell that its margin uses. The margin looks at the exact samples up to one
/// beyond the cell, and each of them is estimated from others up to 7 away.
pub(super) const REACH: usize = 8;
/// The weights of the exact samples at a distance of 1, 3, 5 and 7 on both sides for the one between them.
const BETWEEN: [f64; 4] = [
    1225.0 / 2048.0,
    -245.0 / 2048.0,
    49.0 / 2048.0,
    -5.0 / 2048.0,
];
/// The margin over what the estimates of the exact samples around miss. A jump within the cell may move an estimate
/// by twice as much as it moves those.
const SAFETY: f64 = 4.0;
/// The least margin, as a part of the largest exact sample around: far above rounding.
const ROUNDING: f64 = 1e-9;
/// [`weights`] of all samples within a cell.
const WITHIN: [[f64; 8]; STRIDE - 1] = weights();

/// What is known of a sample: it lies between `lower` and `upper`, which are the same for an exact one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimate {
    pub(super) lower: f64,
    pub(super) upper: f64,
}

impl Estimate {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self = Self {
        lower: 0.0,
        upper: f64::INFINITY,
    };

    /// A sample that is known.
    pub(super) fn exact(value: f64) -> Self {
        Self {
            lower: value,
            upper: value,
        }
    }

    /// The larger of the two absolute values, up to `limit`.
    fn larger(parts: [Interpolation; 2], limit: f64) -> Self {
        let [a, b] = parts;
        Self {
            lower: a.least().max(b.least()).min(limit),
            upper: a.largest().max(b.largest()).min(limit),
        }
    }

    /// The sample if it is exact, else the middle of its limits.
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }

    /// Whether the sample may have this value.
    pub(super) fn allows(&self, value: f64) -> bool {
        (self.lower..=self.upper).contains(&value)
    }

    /// Whether the sample is known.
    pub(super) fn is_exact(&self) -> bool {
        self.lower == self.upper
    }
}

/// An interpolated value, from which the exact one differs by `margin` at the most.
#[derive(Debug, Clone, Copy)]
struct Interpolation {
    value: f64,
    margin: f64,
}

impl Interpolation {
    /// The least absolute value.
    fn least(&self) -> f64 {
        (self.value.abs() - self.margin).max(0.0)
    }

    /// The largest absolute value.
    fn largest(&self) -> f64 {
        self.value.abs() + self.margin
    }
}

/// How many exact samples the estimates of one cell take.
pub(super) const AROUND: usize = 2 * REACH + 2;

/// The samples within the cell between the two exact ones in the middle: each the larger of two absolute values, which
/// are known with their signs at the exact samples `around`, up to `limit`.
pub(super) fn within(around: [&[f64; AROUND]; 2], limit: f64) -> [Estimate; STRIDE - 1] {
    let [a, b] = around.map(interpolate);
    std::array::from_fn(|i| Estimate::larger([a[i], b[i]], limit))
}

fn interpolate(around: &[f64; AROUND]) -> [Interpolation; STRIDE - 1] {
    let missed = (REACH - 1..=REACH + 2).map(|at| (around[at] - between(around, at)).abs());
    let missed = missed.fold(0.0, f64::max);
    let near: [f64; 8] = std::array::from_fn(|i| around[REACH - 3 + i]);
    let largest = near
        .iter()
        .fold(0.0, |largest: f64, near| largest.max(near.abs()));
    let margin = SAFETY * missed + ROUNDING * largest + f64::MIN_POSITIVE;
    WITHIN.map(|weights| {
        let value = weights
            .iter()
            .zip(near)
            .map(|(weight, near)| weight * near)
            .sum::<f64>();
        Interpolation { value, margin }
    })
}

/// The estimate of an exact sample from its neighbours at a distance of 1, 3, 5 and 7.
fn between(around: &[f64; AROUND], at: usize) -> f64 {
    let pairs = BETWEEN.iter().zip([1, 3, 5, 7]);
    pairs
        .map(|(weight, distance)| weight * (around[at - distance] + around[at + distance]))
        .sum()
}

/// Lagrange's weights of nodes at 0 … 7 for the places within the middle cell.
const fn weights() -> [[f64; 8]; STRIDE - 1] {
    let mut all = [[1.0; 8]; STRIDE - 1];
    let mut place = 0;
    while place < STRIDE - 1 {
        let at = 3.0 + (place + 1) as f64 / STRIDE as f64;
        let mut node = 0;
        while node < 8 {
            let mut other = 0;
            while other < 8 {
                if other != node {
                    all[place][node] *= (at - other as f64) / (node as f64 - other as f64);
                }
                other += 1;
            }
            node += 1;
        }
        place += 1;
    }
    all
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Scalar;

    /// The exact samples around the cell that begins at sample 0.
    fn around(sample: impl Fn(f64) -> f64) -> [f64; AROUND] {
        std::array::from_fn(|i| sample((i as f64 - REACH as f64) * STRIDE as f64))
    }

    /// Holds all samples of the cell against their limits, and gives the widest distance of these.
    fn widest(sample: impl Fn(f64) -> f64) -> f64 {
        let none = [0.0; AROUND];
        let estimates = within([&around(&sample), &none], f64::INFINITY);
        let widths = estimates.iter().enumerate().map(|(i, estimate)| {
            let exact = sample((i + 1) as f64).abs();
            assert!(
                (estimate.lower..=estimate.upper).contains(&exact),
                "{i}: {exact} and {estimate:?}"
            );
            estimate.upper - estimate.lower
        });
        widths.fold(0.0, f64::max)
    }

    #[test]
    fn polynomials_of_degree_7_are_met() {
        let sample = |n: f64| {
            let x = n / 50.0;
            1.0 + x * (2.0 - x * x * (0.5 + x * x * (0.1 - 0.2 * x * x)))
        };
        for (i, found) in interpolate(&around(sample)).iter().enumerate() {
            let error = (found.value - sample((i + 1) as f64)).abs();
            assert!(error < 1e-13, "{i}: {error}");
        }
    }

    #[test]
    fn waves_of_more_than_17_samples_lie_within_their_limits() {
        for length in [17.3, 21.0, 31.0, 40.0, 64.5, 123.0, 367.0] {
            for phase in 0..40 {
                widest(|n| Scalar::sin(TAU * n / length + 0.157 * f64::from(phase)) + 0.3 * n);
            }
        }
    }

    #[test]
    fn limits_are_close_on_a_usual_turn_of_734_samples() {
        let width = widest(|n| 2.0 + Scalar::sin(3.0 * TAU * n / 734.0));
        assert!(width < 1e-4, "{width}");
    }

    #[test]
    fn jumps_and_kinks_lie_within_their_limits() {
        for at in -80..=80 {
            let at = f64::from(at) + 0.5;
            widest(|n| if n < at { 1.0 } else { 2.0 });
            widest(|n| if n < at { 2.0 } else { 1.0 });
            widest(|n| (n - at).abs());
            widest(|n| (n - at) * (n - at).max(0.0));
        }
    }

    #[test]
    fn the_larger_part_counts_up_to_the_limit() {
        let (small, large) = (around(|n| n - 4.0), around(|_| -3.5));
        for (limit, expected) in [(f64::INFINITY, 3.5), (2.0, 2.0)] {
            for estimate in within([&small, &large], limit) {
                assert!((estimate.middle() - expected).abs() < 1e-8, "{estimate:?}");
            }
        }
    }
}
