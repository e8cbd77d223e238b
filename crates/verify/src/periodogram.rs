//! Power spectral density of one window of values, under a Hann window.

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use turnpath_core::Scalar;

/// The window function and the Fourier transform for windows of one length.
pub(crate) struct Periodogram {
    window: Vec<f64>,
    /// Sum of the squares of the weights.
    power: f64,
    fft: Arc<dyn Fft<f64>>,
}

impl Periodogram {
    /// For windows of `count` values.
    pub(crate) fn new(count: usize) -> Self {
        let hann = |i: usize| 0.5 - 0.5 * Scalar::cos(TAU * i as f64 / count as f64);
        let window: Vec<f64> = (0..count).map(hann).collect();
        Self {
            power: window.iter().map(|weight| weight * weight).sum(),
            window,
            // The scalar planner uses no vector instructions, which not every CPU has.
            fft: FftPlannerScalar::new().plan_fft_forward(count),
        }
    }

    /// The one-sided density at k = 0 … n/2 of values `step` apart, after `trend` is subtracted.
    pub(crate) fn densities(
        &self,
        values: &[f64],
        trend: impl Fn(usize) -> f64,
        step: f64,
    ) -> Vec<f64> {
        let count = self.window.len();
        let weighted = values.iter().zip(&self.window).enumerate();
        let mut series: Vec<Complex<f64>> = weighted
            .map(|(i, (value, weight))| Complex::new((value - trend(i)) * weight, 0.0))
            .collect();
        self.fft.process(&mut series);
        let one_sided = |k: usize| if 2 * k == count { 1.0 } else { 2.0 };
        let lines = series.iter().take(count / 2 + 1).enumerate();
        lines
            .map(|(k, line)| one_sided(k) * step * line.norm_sqr() / self.power)
            .collect()
    }
}
