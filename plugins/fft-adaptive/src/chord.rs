//! Eq. 1: how long a straight segment may be on a curve of a given radius.

/// The chord that a tolerance e allows on a circle of radius ϱ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chord {
    /// The whole chord of sagitta e, as printed: 2·sqrt(2ϱe − e²).
    Full,
    /// Half of that chord.
    Half,
}

impl Chord {
    /// The chord for the word of a parameter.
    pub fn from_word(word: &str) -> Self {
        match word {
            "half" => Self::Half,
            _ => Self::Full,
        }
    }

    /// The length, mm, for a curvature 1/ϱ (1/mm, of either sign) and a tolerance in mm.
    ///
    /// If the circle is smaller than the tolerance (ϱ < e), a chord of sagitta e does not exist.
    /// The length is then sqrt(ϱe), which continues the formula from ϱ = e on, where it is half of
    /// the chord.
    pub fn length(self, curvature: f64, tolerance: f64) -> f64 {
        let product = tolerance / curvature.abs();
        let half = (2.0 * product - tolerance * tolerance).max(product).sqrt();
        match self {
            Self::Full => 2.0 * half,
            Self::Half => half,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chord of length s on a circle of radius ϱ has the sagitta ϱ − sqrt(ϱ² − s²/4).
    #[test]
    fn the_full_chord_has_the_tolerance_as_its_sagitta() {
        for (radius, tolerance) in [(30.0, 2e-5), (0.1, 1e-3), (1.0, 1.0)] {
            let s = Chord::Full.length(1.0 / radius, tolerance);
            let sagitta = radius - (radius * radius - s * s / 4.0).max(0.0).sqrt();
            assert!((sagitta / tolerance - 1.0).abs() < 1e-9, "{sagitta}");
            assert_eq!(Chord::Half.length(-1.0 / radius, tolerance), s / 2.0);
        }
    }

    #[test]
    fn any_curvature_has_a_length() {
        assert_eq!(Chord::Full.length(0.0, 1e-5), f64::INFINITY);
        let tight = Chord::Full.length(1e12, 1e-5);
        assert!(tight > 0.0 && tight.is_finite());
    }
}
