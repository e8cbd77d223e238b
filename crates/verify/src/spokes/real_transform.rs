//! The Fourier transform of a turn. Its errors are real numbers: those at even and at odd angles go
//! through a complex transform of half the length, as its real and imaginary parts.

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use turnpath_core::Scalar;

use super::turn::{ANGLES, HIGHEST, LOWEST};

/// Length of the complex transform.
const HALF: usize = ANGLES / 2;

/// The transform, with its memory.
#[derive(Clone)]
pub(super) struct RealTransform {
    half: Arc<dyn Fft<f64>>,
    /// −i·exp(−2πik/[`ANGLES`]) for each harmonic k from the lowest on.
    turned: Vec<Complex<f64>>,
    pairs: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Default for RealTransform {
    fn default() -> Self {
        // The scalar planner uses no vector instructions, which not every CPU has.
        let half = FftPlannerScalar::new().plan_fft_forward(HALF);
        let turned = (LOWEST..=HIGHEST).map(|k| {
            let (sin, cos) = Scalar::sin_cos(TAU * k as f64 / ANGLES as f64);
            Complex::new(-sin, -cos)
        });
        Self {
            turned: turned.collect(),
            pairs: vec![Complex::default(); HALF],
            scratch: vec![Complex::default(); half.get_inplace_scratch_len()],
            half,
        }
    }
}

impl RealTransform {
    /// Appends the harmonics of the errors at [`ANGLES`] angles, divided by their number, from the
    /// lowest to the highest.
    pub fn harmonics(&mut self, errors: &[f64], harmonics: &mut Vec<Complex<f64>>) {
        let (pairs, _) = errors.as_chunks::<2>();
        for (slot, [even, odd]) in self.pairs.iter_mut().zip(pairs) {
            *slot = Complex::new(*even, *odd);
        }
        self.half
            .process_with_scratch(&mut self.pairs, &mut self.scratch);
        let upwards = &self.pairs[LOWEST..=HIGHEST];
        let downwards = self.pairs[HALF - HIGHEST..=HALF - LOWEST].iter().rev();
        let scale = 0.5 / ANGLES as f64;
        for ((own, mirror), turned) in upwards.iter().zip(downwards).zip(&self.turned) {
            let mirror = mirror.conj();
            let (even, odd) = (own + mirror, own - mirror);
            harmonics.push((even + turned * odd) * scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_are_those_of_the_sums_over_all_angles() {
        let error = |i: usize| Scalar::sin(0.37 * i as f64 + 0.1) + 1e-3 * ((i * i) % 97) as f64;
        let errors: Vec<f64> = (0..ANGLES).map(error).collect();
        let mut found = Vec::new();
        RealTransform::default().harmonics(&errors, &mut found);
        assert_eq!(found.len(), HIGHEST + 1 - LOWEST);
        for (k, found) in (LOWEST..).zip(&found) {
            let mut sum = Complex::default();
            for (i, error) in errors.iter().enumerate() {
                let angle = TAU * ((k * i) % ANGLES) as f64 / ANGLES as f64;
                let (sin, cos) = Scalar::sin_cos(angle);
                sum += Complex::new(cos, -sin) * error;
            }
            let off = (found - sum / ANGLES as f64).norm();
            assert!(off < 1e-15, "{k}: {off:e}");
        }
    }
}
