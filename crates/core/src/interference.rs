//! The interference check: can this tool cut this surface at all?
//!
//! The check uses sectional curves (Fang et al. 2008). In the radial section through every point,
//! the nose must fit into the hollow, and the contact must stay on the edge where the section rises
//! outward and where it falls. Along the cut, the flank must clear the slope, up and down.

use nalgebra::Vector2;

use crate::crease;
use crate::extreme;
pub use crate::extreme::Extreme;
use crate::profile::{Profile, profile_at};
use crate::{Cut, Gradients, RadialRange, Result, Scalar, StrategyError, Tool, sines_and_cosines};

/// What the part demands of a tool: the extremes of its sectional curves, each with its position.
///
/// Slopes are angles to the horizontal, rad. An angle is below 0 if the section rises (or falls)
/// nowhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Largest curvature of a radial section, 1/mm; positive in a hollow.
    pub curvature: Extreme,
    /// Steepest rise of a radial section outward.
    pub rise: Extreme,
    /// Steepest fall of a radial section outward.
    pub fall: Extreme,
    /// Steepest rise along the cut, in the direction in which C turns.
    pub uphill: Extreme,
    /// Steepest fall along the cut.
    pub downhill: Extreme,
}

/// One way in which a tool does not fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conflict {
    /// The nose is larger than the smallest hollow: Rκ ≥ 1.
    NoseRadius {
        /// The largest nose radius that fits, mm.
        largest: f64,
        /// The point that limits the radius.
        at: Vector2<f64>,
    },
    /// The contact would leave the edge.
    IncludedAngle {
        /// The least included angle that would do, rad.
        least: f64,
        /// The point that needs this angle.
        at: Vector2<f64>,
    },
    /// The flank would rub.
    Clearance {
        /// The least clearance angle that would do, rad.
        least: f64,
        /// The point that needs this angle.
        at: Vector2<f64>,
        /// Whether the surface rises along the cut at this point; otherwise it falls.
        uphill: bool,
    },
}

impl Interference {
    /// The five extremes in a fixed order: curvature, rise, fall, uphill, downhill.
    pub fn extremes(&self) -> [Extreme; 5] {
        [
            self.curvature,
            self.rise,
            self.fall,
            self.uphill,
            self.downhill,
        ]
    }

    /// The inverse of [`extremes`](Interference::extremes): takes the extremes in the same order.
    pub fn from_extremes([curvature, rise, fall, uphill, downhill]: [Extreme; 5]) -> Self {
        Self {
            curvature,
            rise,
            fall,
            uphill,
            downhill,
        }
    }

    /// Largest angle of a radial section to the horizontal, rising or falling, rad.
    pub fn contact_angle(&self) -> Extreme {
        larger(self.fall, self.rise)
    }

    /// Largest angle of the surface along the cut to the horizontal, rising or falling, rad.
    pub fn cut_angle(&self) -> Extreme {
        larger(self.downhill, self.uphill)
    }

    /// The largest nose radius that fits where the check looked, mm; infinite on a part without
    /// hollows. A larger nose touches other points too, so the largest nose that fits may be
    /// smaller: see [`largest_nose`](crate::largest_nose).
    pub fn largest_nose_radius(&self) -> f64 {
        if self.curvature.value > 0.0 {
            self.curvature.value.recip()
        } else {
            f64::INFINITY
        }
    }

    /// The ways in which the tool does not fit; empty if it fits.
    pub fn conflicts(&self, tool: &Tool) -> Vec<Conflict> {
        let mut conflicts = Vec::new();
        if tool.nose_radius * self.curvature.value >= 1.0 {
            conflicts.push(Conflict::NoseRadius {
                largest: self.largest_nose_radius(),
                at: self.curvature.position(),
            });
        }
        let contact = self.contact_angle();
        let exceeded = |angle: f64| contact.value > 0.5 * angle;
        if tool.included_angle.is_some_and(exceeded) {
            conflicts.push(Conflict::IncludedAngle {
                least: 2.0 * contact.value,
                at: contact.position(),
            });
        }
        let cut = self.cut_angle();
        if tool.clearance_angle.is_some_and(|angle| cut.value > angle) {
            conflicts.push(Conflict::Clearance {
                least: cut.value,
                at: cut.position(),
                uphill: self.uphill.value > self.downhill.value,
            });
        }
        conflicts
    }
}

/// The larger extreme; the first if both are equal.
fn larger(first: Extreme, second: Extreme) -> Extreme {
    if second.value > first.value {
        second
    } else {
        first
    }
}

/// Looks for the extremes within `region`: first on a grid, then closer and closer around its
/// highest points. Hollows between the points of the grid, such as the seams of a lens array, are
/// found by the slopes on both sides.
///
/// # Errors
/// If the surface has no height somewhere in `region`.
pub fn check(cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
    let mut measure =
        |theta: &[f64], rho: &[f64], out: &mut [[f64; 5]]| sections(cut, theta, rho, out);
    let mut found = extreme::largest(region, &mut measure).map(Interference::from_extremes)?;
    if let Some(sharper) = crease::sharpest(cut, region, found.curvature.value)? {
        found.curvature = sharper;
    }
    Ok(found)
}

/// The extremes over the given points of contact. There must be at least one point.
///
/// # Errors
/// If the surface has no height at one of the points.
pub fn at(cut: Cut<'_>, theta: &[f64], rho: &[f64]) -> Result<Interference> {
    let mut values = vec![[0.0; 5]; theta.len()];
    sections(cut, theta, rho, &mut values)?;
    let nowhere = Extreme {
        value: f64::NEG_INFINITY,
        theta: 0.0,
        rho: 0.0,
    };
    let mut extremes = [nowhere; 5];
    for ((values, theta), rho) in values.iter().zip(theta).zip(rho) {
        for (extreme, value) in extremes.iter_mut().zip(values) {
            let (value, theta, rho) = (*value, *theta, *rho);
            *extreme = larger(*extreme, Extreme { value, theta, rho });
        }
    }
    Ok(Interference::from_extremes(extremes))
}

/// The sectional curves at each (θ, ρ), in the order of [`Interference::extremes`].
fn sections(cut: Cut<'_>, theta: &[f64], rho: &[f64], out: &mut [[f64; 5]]) -> Result<()> {
    let mut profiles = vec![Profile::default(); theta.len()];
    profile_at(cut.surface, theta, rho, &mut profiles)?;
    let along = slopes_along_cut(cut, theta, rho)?;
    for (i, (profile, along)) in profiles.iter().zip(along).enumerate() {
        let (radial, along) = (Scalar::atan(profile.slope), Scalar::atan(along));
        out[i] = [profile.curvature(), radial, -radial, along, -along];
        if out[i].iter().any(|value| !value.is_finite()) {
            return Err(no_height(theta[i], rho[i]));
        }
    }
    Ok(())
}

/// g_θ/ρ at each (θ, ρ): the component of the gradient across the radius. It exists at the centre
/// too.
fn slopes_along_cut(cut: Cut<'_>, theta: &[f64], rho: &[f64]) -> Result<Vec<f64>> {
    let mut z = vec![0.0; theta.len()];
    let (mut zx, mut zy, mut sines, mut cosines) = (z.clone(), z.clone(), z.clone(), z.clone());
    sines_and_cosines(theta, &mut sines, &mut cosines);
    let turned = sines.iter().zip(&cosines);
    let places = rho.iter().zip(turned.clone());
    let (x, y): (Vec<f64>, Vec<f64>) = places.map(|(rho, (s, c))| (rho * c, rho * s)).unzip();
    cut.surface.gradient(
        &x,
        &y,
        Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        },
    )?;
    Ok(turned
        .zip(zx.iter().zip(&zy))
        .map(|((s, c), (zx, zy))| zy * c - zx * s)
        .collect())
}

fn no_height(theta: f64, rho: f64) -> StrategyError {
    let at = Extreme {
        value: 0.0,
        theta,
        rho,
    }
    .position();
    let position = format!("x = {:.4} mm, y = {:.4} mm", at.x, at.y);
    // No aperture leaves the axis out.
    let advice = match rho == 0.0 {
        true => {
            "that is the axis of rotation: choose a surface that is smooth there, or a hole (`inner`)"
        }
        false => "choose a smaller aperture",
    };
    StrategyError::failed(format!(
        "the surface has no height, slope or curvature at {position}; {advice}"
    ))
}
