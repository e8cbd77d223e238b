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

/// Steps along the radius of the narrowest ring that is checked by itself.
const FEWEST_STEPS: usize = 4;

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
    let stretches = (region, crease::STRETCHES);
    if let Some(sharper) = crease::sharpest(cut, stretches, found.curvature.value)? {
        found.curvature = sharper;
    }
    Ok(found)
}

/// The largest curvature of a radial section within `region`, where it is not within `part`, as
/// [`check`] looks for it; −∞ where `part` covers `region`. The grid is as fine as that of `region` as a
/// whole, so that a narrow ring takes a small part of a check's time.
///
/// # Errors
/// If the surface has no height somewhere in `region` outside `part`.
pub fn curvature_outside(cut: Cut<'_>, part: RadialRange, region: RadialRange) -> Result<Extreme> {
    let rings = [
        (region.inner, part.inner.min(region.outer)),
        (part.outer.max(region.inner), region.outer),
    ];
    let mut largest = Extreme {
        value: f64::NEG_INFINITY,
        theta: 0.0,
        rho: region.outer,
    };
    for (inner, outer) in rings.into_iter().filter(|(inner, outer)| inner < outer) {
        let share = (outer - inner) / (region.outer - region.inner);
        let ring = RadialRange { inner, outer };
        largest = larger(largest, sharpest_hollow(cut, ring, share)?);
    }
    Ok(largest)
}

/// The largest curvature within a ring that is such a share of the region of a check.
fn sharpest_hollow(cut: Cut<'_>, ring: RadialRange, share: f64) -> Result<Extreme> {
    let steps = |of_region: usize| ((share * of_region as f64).ceil() as usize).max(FEWEST_STEPS);
    let mut profiles = Vec::new();
    let [found] = extreme::largest_on(steps(extreme::RADII), ring, &mut |theta, rho, out| {
        profiles.resize(theta.len(), Profile::default());
        profile_at(cut.surface, theta, rho, &mut profiles)?;
        for (i, profile) in profiles.iter().enumerate() {
            let curvature = profile.curvature();
            if !curvature.is_finite() {
                return Err(no_height(theta[i], rho[i]));
            }
            out[i] = [curvature];
        }
        Ok(())
    })?;
    let stretches = (ring, steps(crease::STRETCHES));
    Ok(crease::sharpest(cut, stretches, found.value)?.unwrap_or(found))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Misfit, Surface};

    /// A bowl whose curvature grows outward, more so along y, and which ends at a rim.
    struct Bowl {
        rim: f64,
    }

    impl Surface for Bowl {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = x.squared() + y.squared() * 1.3;
            let on_surface = (-(x.squared() + y.squared()) + self.rim * self.rim).sqrt() * 0.0;
            square.squared() * 1e-3 + square * 0.01 + on_surface
        }
    }

    /// Walls that meet in a valley at x = 0.7.
    struct Valley;

    impl Surface for Valley {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            let off = x - 0.7;
            (off.squared() + 1e-16).sqrt() * 0.1
        }
    }

    const PART: RadialRange = RadialRange {
        inner: 0.5,
        outer: 2.0,
    };

    fn of<T>(surface: &impl Surface, check: impl FnOnce(Cut<'_>) -> T) -> T {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        check(Cut {
            surface,
            tool: &tool,
        })
    }

    fn outside(surface: &impl Surface, inner: f64, outer: f64) -> Result<Extreme> {
        let region = RadialRange { inner, outer };
        of(surface, |cut| curvature_outside(cut, PART, region))
    }

    #[test]
    fn the_curvature_outside_a_part_is_that_of_the_whole_region_where_the_rim_is_most_curved() {
        for outer in [2.0001, 2.01, 2.3, 4.0, 40.0] {
            let found = outside(&Bowl { rim: 50.0 }, 0.0, outer).unwrap();
            let region = RadialRange { inner: 0.0, outer };
            let whole = of(&Bowl { rim: 50.0 }, |cut| check(cut, region)).unwrap();
            let ratio = found.value / whole.curvature.value;
            assert!((ratio - 1.0).abs() < 1e-13, "{outer}: {ratio}");
        }
    }

    #[test]
    fn nothing_is_outside_a_part_that_covers_the_region() {
        let found = outside(&Bowl { rim: 5.0 }, 0.5, 2.0).unwrap();
        assert_eq!(found.value, f64::NEG_INFINITY);
    }

    #[test]
    fn a_crease_counts_where_it_is_outside_the_part() {
        let largest = |inner, outer| outside(&Valley, inner, outer).unwrap();
        // Sections far off x meet the valley in the ring outside; none meets it nearer than 0.7 mm.
        assert!(largest(0.5, 2.1).value > 1e5);
        assert!(largest(0.0, 2.0).value < 1e-9);
    }

    #[test]
    fn a_surface_that_ends_outside_the_part_is_an_error() {
        assert!(outside(&Bowl { rim: 2.5 }, 0.5, 2.4).is_ok());
        let error = outside(&Bowl { rim: 2.5 }, 0.5, 2.6).unwrap_err();
        assert!(error.to_string().contains("no height"), "{error}");
    }
}
