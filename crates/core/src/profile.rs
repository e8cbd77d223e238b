//! The radial profile of a surface at one point.

use crate::{Result, SurfaceModel, sines_and_cosines};

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

/// The radial profile through each (θ, ρ), with its second derivative.
pub fn profile_at(
    surface: &dyn SurfaceModel,
    theta: &[f64],
    rho: &[f64],
    out: &mut [Profile],
) -> Result<()> {
    let count = theta.len();
    let (mut x, mut y, mut z) = (
        vec![[0.0; 5]; count],
        vec![[0.0; 5]; count],
        vec![[0.0; 5]; count],
    );
    let (mut sines, mut cosines) = (vec![0.0; count], vec![0.0; count]);
    sines_and_cosines(theta, &mut sines, &mut cosines);
    for i in 0..count {
        let (s, c) = (sines[i], cosines[i]);
        x[i] = [rho[i] * c, c, 0.0, 0.0, 0.0];
        y[i] = [rho[i] * s, s, 0.0, 0.0, 0.0];
    }
    surface.height_series_to(2, &x, &y, &mut z)?;
    for (profile, z) in out.iter_mut().zip(&z) {
        *profile = Profile {
            height: z[0],
            slope: z[1],
            second: 2.0 * z[2],
        };
    }
    Ok(())
}
