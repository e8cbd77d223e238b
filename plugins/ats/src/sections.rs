//! The radial sections of the surface: their slope and second derivative, each to second order.
//!
//! Five series of order 4 through a point, along (θ, a) = (θ₀ + pt, a₀ + t) with p = 0, ±σ, ±2σ,
//! contain every mixed derivative that the feed needs: of the coefficients g_ij of θ^i a^j, those
//! with i ≤ 2. Nothing is differentiated numerically.

use turnpath_plugin::prelude::*;

use crate::jet::Jet;

/// p/σ of the five curves.
const TURNS: [f64; 5] = [0.0, 1.0, -1.0, 2.0, -2.0];

/// Slope g_a and second derivative g_aa of the section at one point, as functions of (θ, a).
#[derive(Debug, Clone, Copy)]
pub struct Section {
    /// g_a.
    pub slope: Jet,
    /// g_aa, 1/mm.
    pub second: Jet,
}

/// Evaluates sections in batches.
#[derive(Debug, Default)]
pub struct Sections {
    x: Vec<Series>,
    y: Vec<Series>,
    z: Vec<Series>,
}

impl Sections {
    /// The sections at each (θ, a).
    pub fn evaluate(
        &mut self,
        surface: &dyn SurfaceModel,
        theta: &[f64],
        a: &[f64],
        out: &mut Vec<Section>,
    ) -> Result<()> {
        self.clear();
        for (theta, a) in theta.iter().zip(a) {
            for turn in TURNS {
                self.curve(*theta, turn * turning(*a), *a);
            }
        }
        self.heights(surface)?;
        out.clear();
        let sections = self.z.chunks(TURNS.len()).zip(a);
        out.extend(sections.map(|(z, a)| section(z, turning(*a))));
        Ok(())
    }

    /// Only the values of slope and second derivative.
    pub fn values(
        &mut self,
        surface: &dyn SurfaceModel,
        theta: &[f64],
        a: &[f64],
        out: &mut Vec<(f64, f64)>,
    ) -> Result<()> {
        self.clear();
        for (theta, a) in theta.iter().zip(a) {
            self.curve(*theta, 0.0, *a);
        }
        self.heights(surface)?;
        out.clear();
        out.extend(self.z.iter().map(|z| (z[1], 2.0 * z[2])));
        Ok(())
    }

    fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
    }

    fn curve(&mut self, theta: f64, turning: f64, a: f64) {
        let (sin, cos) = Taylor([theta, turning, 0.0, 0.0, 0.0]).sin_cos();
        let radius = Taylor([a, 1.0, 0.0, 0.0, 0.0]);
        self.x.push((radius * cos).0);
        self.y.push((radius * sin).0);
    }

    fn heights(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.z.resize(self.x.len(), [f64::NAN; 5]);
        surface.height_series(&self.x, &self.y, &mut self.z)
    }
}

/// σ, rad/mm. The curves turn about as far as they go outward, so that no term drowns the others.
fn turning(a: f64) -> f64 {
    1.0 / a.abs().max(1.0)
}

fn section(z: &[Series], sigma: f64) -> Section {
    let at = |curve: usize, k: usize| z.get(curve).map_or(f64::NAN, |z| z[k]);
    let even = |k: usize| 0.5 * (at(1, k) + at(2, k));
    let odd = |k: usize| 0.5 * (at(1, k) - at(2, k));
    let odd_twice = |k: usize| 0.5 * (at(3, k) - at(4, k));
    let even_twice = |k: usize| 0.5 * (at(3, k) + at(4, k));
    // The coefficients of t^k that belong to p^0, p^1 and p^2, for k up to 4.
    let zeroth = |k: usize| at(0, k);
    let first = |k: usize| (8.0 * odd(k) - odd_twice(k)) / (6.0 * sigma);
    let second = |k: usize| {
        (16.0 * (even(k) - at(0, k)) - (even_twice(k) - at(0, k))) / (12.0 * sigma * sigma)
    };
    Section {
        slope: Jet {
            value: zeroth(1),
            r: 2.0 * zeroth(2),
            rr: 6.0 * zeroth(3),
            t: first(2),
            tr: 2.0 * first(3),
            tt: 2.0 * second(3),
        },
        second: Jet {
            value: 2.0 * zeroth(2),
            r: 6.0 * zeroth(3),
            rr: 24.0 * zeroth(4),
            t: 2.0 * first(3),
            tr: 6.0 * first(4),
            tt: 4.0 * second(4),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Waves;

    impl Surface for Waves {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            (x * 0.4 + y.squared() * 0.1).sin() * 0.3 + x.powi(3) * y * 0.01
        }
    }

    /// Compares each derivative with a difference of the derivative below it.
    #[test]
    fn the_derivatives_are_those_of_the_slopes_and_curvatures() {
        let (theta, h) = (0.7, 1e-5);
        for a in [-1.3, 0.0, 0.4, 2.6] {
            let places = [
                (theta, a),
                (theta - h, a),
                (theta + h, a),
                (theta, a - h),
                (theta, a + h),
            ];
            let (theta, radius): (Vec<f64>, Vec<f64>) = places.into_iter().unzip();
            let mut found = Vec::new();
            let mut sections = Sections::default();
            sections
                .evaluate(&Waves, &theta, &radius, &mut found)
                .unwrap();
            let mut values = Vec::new();
            sections
                .values(&Waves, &theta, &radius, &mut values)
                .unwrap();
            for (section, values) in found.iter().zip(values) {
                assert_eq!((section.slope.value, section.second.value), values);
            }
            for of in [|s: &Section| s.slope, |s: &Section| s.second] {
                let j: Vec<Jet> = found.iter().map(of).collect();
                let rate = |i: usize, of: fn(&Jet) -> f64| (of(&j[i + 1]) - of(&j[i])) / (2.0 * h);
                for (exact, difference) in [
                    (j[0].t, rate(1, |j| j.value)),
                    (j[0].r, rate(3, |j| j.value)),
                    (j[0].tt, rate(1, |j| j.t)),
                    (j[0].tr, rate(1, |j| j.r)),
                    (j[0].tr, rate(3, |j| j.t)),
                    (j[0].rr, rate(3, |j| j.r)),
                ] {
                    assert!(
                        (exact - difference).abs() < 1e-8,
                        "{exact} {difference}, a = {a}"
                    );
                }
            }
        }
    }
}
