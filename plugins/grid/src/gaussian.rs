//! The weights of a Gaussian filter along one axis, as ISO 16610-61 has them.

use std::f64::consts::{LN_2, PI};

use turnpath_plugin::prelude::Scalar;

/// The Gaussian ends at this distance, in cutoffs, where its weight is 6.5e-7.
const END: f64 = 1.0;

/// Weights along one axis.
pub struct Gaussian {
    /// From the middle on; the sum over both sides is 1.
    weights: Vec<f64>,
    /// Numbers that count on each side of the middle.
    pub reach: usize,
}

impl Gaussian {
    /// The weights of a cutoff, in numbers.
    pub fn new(cutoff: f64) -> Self {
        let reach = (cutoff * END).ceil() as usize;
        let weight = |k: usize| {
            let share = k as f64 / cutoff;
            Scalar::exp(-share * share * (PI * PI / LN_2))
        };
        let mut weights: Vec<f64> = (0..=reach).map(weight).collect();
        let sum: f64 = weights.iter().skip(1).sum::<f64>() * 2.0 + 1.0;
        for weight in &mut weights {
            *weight /= sum;
        }
        Self { weights, reach }
    }

    /// The weight of one number for another one, by their places.
    pub fn at(&self, one: usize, other: usize) -> f64 {
        self.weights
            .get(one.abs_diff(other))
            .copied()
            .unwrap_or(0.0)
    }
}
