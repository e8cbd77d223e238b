//! The radial profile of a surface at one point, and the feed that keeps the residual there.

use crate::{Misfit, Radial, Result, Scalar, SurfaceModel, Tool};

/// The largest feed as a part of the nose radius. Where Rκ approaches 1, the residual feed would
/// grow without bound, and its formula is no longer true.
pub const LARGEST_FEED: f64 = 0.1;

/// The least value of 1 − Rκ in the residual feed with [`Misfit::CutWhatFits`]. The feed there is a
/// seventh of the feed on a flat. The formula goes to zero where the nose touches a hollow of its
/// own radius in one point. A seam beside such a point leaves cusps that grow with the feed itself,
/// not with its square, and no formula of the curvature describes these cusps.
pub const LEAST_GAP: f64 = 0.02;

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

    /// The feed that [`Locus::residual_feed`](crate::Locus::residual_feed) describes.
    pub fn residual_feed(&self, residual: f64, radial: Radial, tool: &Tool) -> f64 {
        let nose_radius = tool.nose_radius;
        let gap = match (1.0 - nose_radius * self.curvature(), tool.misfit) {
            (gap, Misfit::CutWhatFits) if gap < LEAST_GAP => LEAST_GAP,
            (gap, _) => gap,
        };
        let cap = LARGEST_FEED * nose_radius;
        if gap <= 0.0 {
            return cap;
        }
        let squared = match radial {
            Radial::Contact => 8.0 * nose_radius * residual / gap,
            Radial::Centre => 8.0 * nose_radius * residual * gap,
        };
        let feed = squared.sqrt() / self.slant();
        if feed > cap { cap } else { feed }
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
    for i in 0..count {
        let (s, c) = Scalar::sin_cos(theta[i]);
        x[i] = [rho[i] * c, c, 0.0, 0.0, 0.0];
        y[i] = [rho[i] * s, s, 0.0, 0.0, 0.0];
    }
    surface.height_series(&x, &y, &mut z)?;
    for (profile, z) in out.iter_mut().zip(&z) {
        *profile = Profile {
            height: z[0],
            slope: z[1],
            second: 2.0 * z[2],
        };
    }
    Ok(())
}
