//! The feed that the law follows: the one that keeps the residual, or the paper's.

use turnpath_plugin::locus::{CuspFeed, Profile, profile_at};
use turnpath_plugin::prelude::*;
use turnpath_plugin::ring::{FeedTable, least_over_angles};

/// The feed whose smallest value over the angles is F.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residual {
    /// The feed that keeps the residual for the actual meaning of ρ, with curvature and slope at
    /// the contact.
    Exact,
    /// Wang et al. 2019, eq. 1–4: the feed of a contact's radius, whatever ρ means. It takes the
    /// smallest curvature and the largest slope of the bare surface at ρ, each at its own angle.
    Paper,
}

impl Residual {
    /// F over the task's range.
    ///
    /// # Errors
    /// If the range has no length, or if the surface or the locus has no value.
    pub fn table(self, setup: Setup<'_>) -> Result<FeedTable> {
        match self {
            Residual::Exact => FeedTable::for_residual(setup),
            Residual::Paper => FeedTable::tabulate(setup.task.range, &|rho| paper_feed(setup, rho)),
        }
    }
}

/// Eq. 1–4: f = sqrt(8Rε/(1 − R·min κ))/sqrt(1 + max g_ρ²), as far as neighbouring noses meet within
/// their edges. The cap is that of what ρ really is.
fn paper_feed(setup: Setup<'_>, rho: f64) -> Result<f64> {
    let surface = setup.locus.surface();
    let curvature = |profile: &Profile| profile.curvature();
    let flatness = |profile: &Profile| -profile.slope.abs();
    let curvature = least_over_angles(&sections(surface, &curvature), rho)?;
    let slope = least_over_angles(&sections(surface, &flatness), rho)?;
    let radius = setup.task.tool.nose_radius;
    let tool = &setup.task.tool;
    let gap = 1.0 - radius * curvature;
    let law = CuspFeed::new(setup.task.tolerance.residual, setup.locus.radial(), tool);
    let cap = law.cap(slope, gap);
    if gap <= 0.0 {
        return Ok(cap);
    }
    let along = (8.0 * radius * setup.task.tolerance.residual / gap).sqrt();
    Ok((along / (1.0 + slope * slope).sqrt()).min(cap))
}

/// A measure of the bare surface: the value of `of` for each radial profile.
fn sections<'a>(
    surface: &'a dyn SurfaceModel,
    of: &'a dyn Fn(&Profile) -> f64,
) -> impl Fn(&[f64], &[f64], &mut [f64]) -> Result<()> + 'a {
    move |theta, rho, out| {
        let mut profiles = vec![Profile::default(); theta.len()];
        profile_at(surface, theta, rho, &mut profiles)?;
        for (out, profile) in out.iter_mut().zip(&profiles) {
            *out = of(profile);
        }
        Ok(())
    }
}
