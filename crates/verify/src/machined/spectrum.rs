//! Power spectral density of a profile.

use crate::periodogram::Periodogram;

/// One line of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectrumLine {
    /// Periods per mm.
    pub frequency: f64,
    /// One-sided density, mm² mm. Its integral over the frequency is the mean square about the
    /// mean.
    pub density: f64,
}

/// The one-sided power spectral density of values `step` mm apart, with the mean removed, under a
/// Hann window. Values that are not finite divide the profile into pieces. Only the longest pieces
/// count: they are cut to the same length, and their spectra are averaged.
pub fn power_spectrum(values: &[f64], step: f64) -> Vec<SpectrumLine> {
    let pieces: Vec<&[f64]> = values
        .split(|value| !value.is_finite())
        .filter(|piece| !piece.is_empty())
        .collect();
    let longest = pieces.iter().map(|piece| piece.len()).max().unwrap_or(0);
    // The two sides of a hole differ in length by one or two values.
    let alike = |piece: &&&[f64]| piece.len() + 2 >= longest;
    let alike: Vec<&[f64]> = pieces.iter().filter(alike).copied().collect();
    let length = alike.iter().map(|piece| piece.len()).min().unwrap_or(0);
    if length < 3 {
        return Vec::new();
    }
    let periodogram = Periodogram::new(length);
    let densities = |piece: &[f64]| {
        let mean = mean_of(piece);
        periodogram.densities(piece, |_| mean, step)
    };
    let pieces = alike.iter().map(|piece| &piece[..length]);
    let spectra: Vec<Vec<f64>> = pieces.map(densities).collect();
    let mean = |k: usize| spectra.iter().map(|one| one[k]).sum::<f64>() / spectra.len() as f64;
    let line = |k: usize| SpectrumLine {
        frequency: k as f64 / (length as f64 * step),
        density: mean(k),
    };
    (1..=length / 2).map(line).collect()
}

fn mean_of(piece: &[f64]) -> f64 {
    piece.iter().sum::<f64>() / piece.len() as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use turnpath_core::Scalar;

    use super::*;

    fn wave(count: usize, step: f64, frequency: f64) -> Vec<f64> {
        let value = |i: usize| 3.0 * Scalar::sin(TAU * frequency * step * i as f64) + 50.0;
        (0..count).map(value).collect()
    }

    fn top(lines: &[SpectrumLine]) -> f64 {
        let higher = |a: &&SpectrumLine, b: &&SpectrumLine| a.density.total_cmp(&b.density);
        lines.iter().max_by(higher).unwrap().frequency
    }

    #[test]
    fn a_wave_has_its_frequency_and_half_its_amplitudes_square() {
        let lines = power_spectrum(&wave(1000, 0.01, 4.0), 0.01);
        assert_eq!(top(&lines), 4.0);
        let width = lines[1].frequency - lines[0].frequency;
        let power: f64 = lines.iter().map(|line| line.density * width).sum();
        assert!((power / 4.5 - 1.0).abs() < 1e-9, "{power}");
    }

    #[test]
    fn both_sides_of_a_hole_are_averaged() {
        let mut values = wave(1001, 0.01, 4.0);
        values[400..600].fill(f64::NAN);
        let lines = power_spectrum(&values, 0.01);
        assert_eq!(top(&lines), 4.0);
        assert_eq!(lines.len(), 200);
    }

    #[test]
    fn an_empty_profile_has_no_spectrum() {
        assert!(power_spectrum(&[f64::NAN; 9], 0.1).is_empty());
        assert!(power_spectrum(&[], 0.1).is_empty());
    }
}
