//! The highest harmonic of a height over one revolution whose amplitude reaches a tolerance.
//!
//! rustfft takes its sines and cosines from the standard library, whose last digit depends on the
//! CPU. Only one number of a spectrum leaves this file. If an amplitude is so close to the
//! tolerance that rounding could decide, the sum is computed again with sines and cosines of
//! `Scalar`. So the answer is the same on every machine.

use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use turnpath_plugin::prelude::*;

/// Samples of a revolution in the first transform.
pub const SAMPLES: usize = 4096;
/// Most samples.
const MOST_SAMPLES: usize = 1 << 16;
/// A harmonic above this part of the number of samples makes the search double the samples. A
/// harmonic above half of them shows at a wrong frequency.
const TRUSTED: f64 = 0.25;
/// An amplitude this close to the tolerance is summed again, as a part of the largest |height|.
/// This is a thousand times the rounding of the transform.
const DOUBT: f64 = 1e-11;

/// Transforms of one size, shared by all blocks.
#[derive(Clone)]
pub struct Harmonics {
    transform: Arc<dyn Fft<f64>>,
}

impl Default for Harmonics {
    fn default() -> Self {
        Self::of(SAMPLES)
    }
}

impl Harmonics {
    /// Plans the transform with the scalar planner, which does not depend on the features of the
    /// CPU.
    fn of(samples: usize) -> Self {
        Self {
            transform: FftPlannerScalar::new().plan_fft_forward(samples),
        }
    }

    /// The highest k ≥ 1 with 2|F_k|/n ≥ `tolerance`, or 0 if there is none. `heights` fills the
    /// slice with the heights at even angles from 0 on.
    ///
    /// # Errors
    /// The errors of `heights`.
    pub fn highest(
        &self,
        tolerance: f64,
        mut heights: impl FnMut(&mut [f64]) -> Result<()>,
    ) -> Result<usize> {
        let mut samples = self.transform.len();
        let mut highest = self.transform(tolerance, &mut heights)?;
        while highest as f64 > TRUSTED * samples as f64 && samples < MOST_SAMPLES {
            samples *= 4;
            highest = Self::of(samples).transform(tolerance, &mut heights)?;
        }
        Ok(highest)
    }

    fn transform(
        &self,
        tolerance: f64,
        heights: &mut impl FnMut(&mut [f64]) -> Result<()>,
    ) -> Result<usize> {
        let count = self.transform.len();
        let mut z = vec![f64::NAN; count];
        heights(&mut z)?;
        let mut spectrum: Vec<Complex<f64>> = z.iter().map(|z| Complex::new(*z, 0.0)).collect();
        self.transform.process(&mut spectrum);
        let doubt = DOUBT * z.iter().fold(0.0f64, |most, z| most.max(z.abs()));
        let mut circle = Vec::new();
        for k in (1..count / 2).rev() {
            let amplitude = spectrum.get(k).map_or(0.0, |f| size(f.re, f.im, count));
            let beyond = amplitude - tolerance;
            if beyond > doubt || (beyond >= -doubt && summed(&z, k, &mut circle) >= tolerance) {
                return Ok(k);
            }
        }
        Ok(0)
    }
}

/// 2|F|/n.
fn size(re: f64, im: f64, count: usize) -> f64 {
    2.0 * (re * re + im * im).sqrt() / count as f64
}

/// 2|F_k|/n, summed term by term.
fn summed(z: &[f64], k: usize, circle: &mut Vec<(f64, f64)>) -> f64 {
    let count = z.len();
    if circle.is_empty() {
        circle.extend((0..count).map(|j| Scalar::sin_cos(TAU * j as f64 / count as f64)));
    }
    let (mut re, mut im) = (0.0, 0.0);
    for (j, z) in z.iter().enumerate() {
        let (sin, cos) = circle[j * k % count];
        re += z * cos;
        im += z * sin;
    }
    size(re, im, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 + 3 cos 5θ + 0.2 sin 40θ + 0.01 cos 900θ, and one more wave.
    fn heights(wave: (f64, f64)) -> impl FnMut(&mut [f64]) -> Result<()> {
        move |z| {
            let count = z.len() as f64;
            for (j, z) in z.iter_mut().enumerate() {
                let turn = |k: f64| TAU * ((k * j as f64) % count) / count;
                *z = 1.0
                    + 3.0 * Scalar::cos(turn(5.0))
                    + 0.2 * Scalar::sin(turn(40.0))
                    + 0.01 * Scalar::cos(turn(900.0))
                    + wave.1 * Scalar::cos(turn(wave.0));
            }
            Ok(())
        }
    }

    fn highest(tolerance: f64, wave: (f64, f64)) -> usize {
        Harmonics::default()
            .highest(tolerance, heights(wave))
            .unwrap()
    }

    #[test]
    fn the_result_is_the_highest_harmonic_as_large_as_the_tolerance() {
        for (tolerance, expected) in [(4.0, 0), (1.0, 5), (0.19, 40), (0.21, 5), (0.005, 900)] {
            assert_eq!(highest(tolerance, (0.0, 0.0)), expected, "{tolerance}");
        }
    }

    /// Amplitudes that differ from the tolerance by a few units of the last digit.
    #[test]
    fn at_the_tolerance_itself_the_sum_decides() {
        assert_eq!(highest(0.1, (77.0, 0.1 + 1e-14)), 77);
        assert_eq!(highest(0.1, (77.0, 0.1 - 1e-14)), 40);
    }

    /// With 4096 samples, harmonic 3000 would show as 1096.
    #[test]
    fn a_harmonic_above_half_of_the_samples_takes_more_samples() {
        assert_eq!(highest(0.1, (3000.0, 0.5)), 3000);
    }

    #[test]
    fn the_sum_is_the_transform() {
        let mut z = vec![0.0; SAMPLES];
        heights((0.0, 0.0))(&mut z).unwrap();
        let mut spectrum: Vec<Complex<f64>> = z.iter().map(|z| Complex::new(*z, 0.0)).collect();
        Harmonics::default().transform.process(&mut spectrum);
        for k in [1, 5, 40, 900, 2000] {
            let transformed = size(spectrum[k].re, spectrum[k].im, SAMPLES);
            let off = (summed(&z, k, &mut Vec::new()) - transformed).abs();
            assert!(off < 0.01 * DOUBT, "{off}");
        }
    }
}
