//! The interference check: can this tool cut this surface at all?
//!
//! Sectional curves (Fang et al. 2008): in the radial section through every place the nose must
//! fit the hollow and the contact stay on the edge; along the cut the flank must clear the slope.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector2;

use crate::locus::{Profile, profile_at};
use crate::{Cut, Gradients, RadialRange, Result, Scalar, StrategyError, Tool};

/// Angles of the first, coarse look.
const ANGLES: usize = 180;
/// Radii of the first, coarse look.
const RADII: usize = 128;
/// Halvings of the coarse grid's step when an extreme is closed in on: 2⁻⁴⁰ of 2° and of the
/// aperture are far below what a curvature can tell.
const HALVINGS: usize = 40;

/// The largest value of something on the part, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// C angle, rad.
    pub theta: f64,
    /// Radius, mm.
    pub rho: f64,
}

impl Extreme {
    /// The place as (x, y), mm.
    pub fn place(&self) -> Vector2<f64> {
        let (s, c) = Scalar::sin_cos(self.theta);
        Vector2::new(self.rho * c, self.rho * s)
    }
}

/// What the part asks of a tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Largest curvature of a radial section, 1/mm; positive: a hollow.
    pub curvature: Extreme,
    /// Largest angle of a radial section to the horizontal, rad.
    pub contact_angle: Extreme,
    /// Largest angle of the surface along the cut to the horizontal, up or down, rad.
    pub cut_angle: Extreme,
}

/// One way in which a tool does not fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conflict {
    /// The nose is larger than the smallest hollow: Rκ ≥ 1.
    NoseRadius {
        /// The smallest concave radius, mm.
        largest: f64,
        /// Where it is.
        at: Vector2<f64>,
    },
    /// The contact would leave the edge.
    IncludedAngle {
        /// The included angle that would do, rad.
        least: f64,
        /// Where it is needed.
        at: Vector2<f64>,
    },
    /// The flank would rub.
    Clearance {
        /// The clearance angle that would do, rad.
        least: f64,
        /// Where it is needed.
        at: Vector2<f64>,
    },
}

impl Interference {
    /// The largest nose radius that fits, mm; infinite on a part without hollows.
    pub fn largest_nose_radius(&self) -> f64 {
        if self.curvature.value > 0.0 {
            self.curvature.value.recip()
        } else {
            f64::INFINITY
        }
    }

    /// In which ways the tool does not fit; empty where it does.
    pub fn conflicts(&self, tool: &Tool) -> Vec<Conflict> {
        let mut found = Vec::new();
        if tool.nose_radius * self.curvature.value >= 1.0 {
            let largest = self.largest_nose_radius();
            found.push(Conflict::NoseRadius {
                largest,
                at: self.curvature.place(),
            });
        }
        if tool
            .included_angle
            .is_some_and(|angle| self.contact_angle.value > 0.5 * angle)
        {
            let least = 2.0 * self.contact_angle.value;
            found.push(Conflict::IncludedAngle {
                least,
                at: self.contact_angle.place(),
            });
        }
        if tool
            .clearance_angle
            .is_some_and(|angle| self.cut_angle.value > angle)
        {
            let least = self.cut_angle.value;
            found.push(Conflict::Clearance {
                least,
                at: self.cut_angle.place(),
            });
        }
        found
    }
}

/// Looks for the extremes within `region`: on a grid, then closing in on the largest.
///
/// # Errors
/// Where the surface has no height.
pub fn check(cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
    let grid = Grid::new(region);
    let mut best: [Option<Extreme>; 3] = [None; 3];
    for row in grid.rows() {
        for (theta, rho, measures) in measure(cut, &row)? {
            for (best, value) in best.iter_mut().zip(measures) {
                if best.is_none_or(|best| value > best.value) {
                    *best = Some(Extreme { value, theta, rho });
                }
            }
        }
    }
    let mut closed_in = [Extreme {
        value: 0.0,
        theta: 0.0,
        rho: region.inner,
    }; 3];
    for (which, best) in best.into_iter().enumerate() {
        if let Some(best) = best {
            closed_in[which] = grid.close_in(cut, which, best)?;
        }
    }
    let [curvature, contact_angle, cut_angle] = closed_in;
    Ok(Interference {
        curvature,
        contact_angle,
        cut_angle,
    })
}

struct Grid {
    region: RadialRange,
    theta_step: f64,
    rho_step: f64,
}

impl Grid {
    fn new(region: RadialRange) -> Self {
        let rho_step = (region.outer - region.inner) / RADII as f64;
        Self {
            region,
            theta_step: TAU / ANGLES as f64,
            rho_step,
        }
    }

    /// The grid as one batch a radius.
    fn rows(&self) -> impl Iterator<Item = Vec<(f64, f64)>> + '_ {
        (0..=RADII).map(|i| {
            let rho = self.region.inner + i as f64 * self.rho_step;
            (0..ANGLES)
                .map(|j| (j as f64 * self.theta_step, rho))
                .collect()
        })
    }

    /// Compass search: the best of eight neighbours, at half the step when none is better.
    fn close_in(&self, cut: Cut<'_>, which: usize, mut best: Extreme) -> Result<Extreme> {
        let mut scale = 0.5;
        for _ in 0..HALVINGS {
            let around: Vec<(f64, f64)> = NEIGHBOURS
                .iter()
                .map(|(turn, out)| {
                    let theta = best.theta + turn * scale * self.theta_step;
                    let rho = best.rho + out * scale * self.rho_step;
                    (theta, rho.clamp(self.region.inner, self.region.outer))
                })
                .collect();
            let before = best.value;
            for (theta, rho, measures) in measure(cut, &around)? {
                if measures[which] > best.value {
                    best = Extreme {
                        value: measures[which],
                        theta,
                        rho,
                    };
                }
            }
            if best.value == before {
                scale *= 0.5;
            }
        }
        Ok(best)
    }
}

const NEIGHBOURS: [(f64, f64); 8] = [
    (-1.0, -1.0),
    (-1.0, 0.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 1.0),
    (1.0, -1.0),
    (1.0, 0.0),
    (1.0, 1.0),
];

/// Curvature, contact angle and angle along the cut at each (θ, ρ).
fn measure(cut: Cut<'_>, places: &[(f64, f64)]) -> Result<Vec<(f64, f64, [f64; 3])>> {
    let theta: Vec<f64> = places.iter().map(|place| place.0).collect();
    let rho: Vec<f64> = places.iter().map(|place| place.1).collect();
    let mut profiles = vec![Profile::default(); places.len()];
    profile_at(cut.surface, &theta, &rho, &mut profiles)?;
    let along = slopes_along_cut(cut, places)?;
    let mut measured = Vec::with_capacity(places.len());
    for (((theta, rho), profile), along) in places.iter().zip(&profiles).zip(&along) {
        let values = [
            profile.curvature(),
            steepness(profile.slope),
            steepness(*along),
        ];
        if values.iter().any(|value| !value.is_finite()) {
            return Err(no_height(*theta, *rho));
        }
        measured.push((*theta, *rho, values));
    }
    Ok(measured)
}

fn steepness(slope: f64) -> f64 {
    let angle = Scalar::atan(slope.abs());
    if slope.is_infinite() {
        FRAC_PI_2
    } else {
        angle
    }
}

/// g_θ/ρ at each (θ, ρ): the gradient's part across the radius, which the centre has too.
fn slopes_along_cut(cut: Cut<'_>, places: &[(f64, f64)]) -> Result<Vec<f64>> {
    let turned: Vec<(f64, f64)> = places
        .iter()
        .map(|place| Scalar::sin_cos(place.0))
        .collect();
    let x: Vec<f64> = places
        .iter()
        .zip(&turned)
        .map(|(place, (_, c))| place.1 * c)
        .collect();
    let y: Vec<f64> = places
        .iter()
        .zip(&turned)
        .map(|(place, (s, _))| place.1 * s)
        .collect();
    let mut z = vec![0.0; places.len()];
    let (mut zx, mut zy) = (z.clone(), z.clone());
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
        .iter()
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
    .place();
    let place = format!("x = {:.4} mm, y = {:.4} mm", at.x, at.y);
    StrategyError::failed(format!(
        "the surface has no height, slope or curvature at {place}; choose a smaller aperture"
    ))
}
