//! The radial profile of a surface at one point.

use crate::{ORDER, Result, SurfaceModel, sines_and_cosines};

/// The radial profile z = g(θ, ρ) at one point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Profile {
    /// g, mm.
    pub height: f64,
    /// g_ρ.
    pub slope: f64,
    /// g_ρρ, 1/mm.
    pub second: f64,
}

impl Profile {
    /// w = sqrt(1 + g_ρ²).
    pub fn slant(&self) -> f64 {
        (1.0 + self.slope * self.slope).sqrt()
    }

    /// κ = g_ρρ/w³, 1/mm; positive in a hollow, as the tool sees it.
    pub fn curvature(&self) -> f64 {
        let w = self.slant();
        self.second / (w * w * w)
    }
}

/// Profiles that go through a surface together: their series stay in the cache of the first level.
const TOGETHER: usize = 128;

/// The radial profile through each (θ, ρ), with its second derivative. All slices have one length.
pub fn profile_at(
    surface: &dyn SurfaceModel,
    theta: &[f64],
    rho: &[f64],
    out: &mut [Profile],
) -> Result<()> {
    let together = theta.len().min(TOGETHER);
    let [mut x, mut y, mut z] = [(); 3].map(|()| vec![[0.0; ORDER + 1]; together]);
    let [mut sines, mut cosines] = [[0.0; TOGETHER]; 2];
    let places = theta.chunks(TOGETHER).zip(rho.chunks(TOGETHER));
    for ((theta, rho), out) in places.zip(out.chunks_mut(TOGETHER)) {
        let count = theta.len();
        let (sines, cosines) = (&mut sines[..count], &mut cosines[..count]);
        sines_and_cosines(theta, sines, cosines);
        let (x, y, z) = (&mut x[..count], &mut y[..count], &mut z[..count]);
        let lines = x.iter_mut().zip(&mut *y);
        let rays = sines.iter().zip(&*cosines).zip(rho);
        for ((x, y), ((sine, cosine), rho)) in lines.zip(rays) {
            (x[0], x[1]) = (rho * cosine, *cosine);
            (y[0], y[1]) = (rho * sine, *sine);
        }
        surface.height_series_to(2, x, y, z)?;
        for (profile, z) in out.iter_mut().zip(&*z) {
            *profile = Profile {
                height: z[0],
                slope: z[1],
                second: 2.0 * z[2],
            };
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_surface::Waves;

    #[test]
    fn profiles_of_any_number_of_places_are_those_of_single_places() {
        for count in [0, 1, TOGETHER - 1, TOGETHER, TOGETHER + 1, 3 * TOGETHER + 7] {
            let theta: Vec<f64> = (0..count).map(|i| 0.1 * i as f64).collect();
            let rho: Vec<f64> = (0..count).map(|i| 2.0 - 0.01 * i as f64).collect();
            let mut all = vec![Profile::default(); count];
            profile_at(&Waves, &theta, &rho, &mut all).unwrap();
            for ((theta, rho), profile) in theta.iter().zip(&rho).zip(&all) {
                let mut alone = [Profile::default()];
                profile_at(&Waves, &[*theta], &[*rho], &mut alone).unwrap();
                assert_eq!(*profile, alone[0], "{count}: {theta} {rho}");
            }
        }
    }
}
